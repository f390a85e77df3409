//! Where the bytes go: a serial port, or a simulated bus.

use std::{io, time::Duration};

/// The port cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum WireError {
    #[error("cannot open {port}: {why}")]
    Open { port: String, why: String },
    #[error(
        "{port} no longer works: {source}; is its cable in, and has no other program taken it? The servos keep their last \
         goals meanwhile"
    )]
    Lost { port: String, source: io::Error },
}

/// A half-duplex line to servos.
pub trait Wire: Send {
    /// The name for messages, such as `/dev/ttyACM0`.
    fn name(&self) -> &str;

    /// Time since some moment in the past. It never goes back. A simulated bus has a time of its own.
    fn now(&self) -> Duration;

    fn send(&mut self, bytes: &[u8]) -> Result<(), WireError>;

    /// Waits until there are bytes, at the longest until `deadline` on the clock of [`now`](Self::now). Returns their number, which
    /// is zero at the deadline.
    fn receive(&mut self, buffer: &mut [u8], deadline: Duration) -> Result<usize, WireError>;

    /// Changes the speed in bits per second.
    fn set_baud(&mut self, bps: u32) -> Result<(), WireError>;

    /// Opens the line again after it was lost.
    fn reopen(&mut self) -> Result<(), WireError>;
}
