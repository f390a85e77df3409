//! Servos on a serial bus: the protocol of Feetech's STS series, as an STS3215 speaks it.
//!
//! One bad, short, late or alien packet never ends a loop. A question is asked again until it is answered, at most
//! [`Retries::tries`] times, and what then is missing is an error of one servo: the others are usable. A late answer is never
//! taken for that of the next question.
//!
//! ```no_run
//! use robot_arm::bus::{ServoBus, register};
//!
//! let mut bus = ServoBus::open("/dev/ttyACM0", 1_000_000)?;
//! let position = bus.read(1, register::PRESENT_POSITION)?;
//! println!("{} steps, alarms: {}", position.value, position.alarms);
//! # Ok::<(), robot_arm::bus::BusError>(())
//! ```

pub mod register;

mod alarms;
mod ask;
mod block;
mod eeprom;
mod error;
mod exchange;
mod frame;
mod parser;
mod read;
mod scan;
mod serial;
mod statistics;
mod timing;
mod wire;
mod write;

use std::{
    collections::{BTreeMap, BTreeSet},
    time::Duration,
};

pub use alarms::Alarms;
pub use block::{Block, BlockReading};
pub use error::{BusError, Cause, ServoError};
pub use read::Reading;
pub use scan::{BAUD_RATES, Identity, Presence};
pub use serial::SerialWire;
pub use statistics::Statistics;
pub use timing::Retries;
pub use wire::{Wire, WireError};

use parser::Parser;
use timing::Timing;

/// The highest id of a servo.
pub const LAST_ID: u8 = 253;

/// A bus with servos.
pub struct ServoBus {
    wire: Box<dyn Wire>,
    timing: Timing,
    retries: Retries,
    parser: Parser,
    statistics: Statistics,
    /// Bytes that came when nothing was asked.
    unasked_bytes: u64,
    names: BTreeMap<u8, String>,
    /// Servos that did not answer the last question after all tries.
    silent: BTreeSet<u8>,
    /// Servos whose late answer may still come.
    unsettled: BTreeSet<u8>,
    /// Bytes that are read beyond what is wanted, to tell the answer from a late one.
    extra: u8,
    last_had_echo: bool,
    /// Servos that answer reads only.
    mute: BTreeSet<u8>,
}

impl ServoBus {
    /// Opens a serial port at a speed in bits per second.
    pub fn open(port: &str, bps: u32) -> Result<Self, BusError> {
        Ok(Self::new(Box::new(SerialWire::open(port, bps)?), bps))
    }

    /// Takes a line that runs at `bps`.
    pub fn new(wire: Box<dyn Wire>, bps: u32) -> Self {
        Self {
            wire,
            timing: Timing::new(bps),
            retries: Retries::default(),
            parser: Parser::default(),
            statistics: Statistics::default(),
            unasked_bytes: 0,
            names: BTreeMap::new(),
            silent: BTreeSet::new(),
            unsettled: BTreeSet::new(),
            extra: 0,
            last_had_echo: false,
            mute: BTreeSet::new(),
        }
    }

    /// Gives a servo a name for messages.
    pub fn name(&mut self, id: u8, joint: &str) {
        self.names.insert(id, joint.to_owned());
    }

    pub fn port(&self) -> &str {
        self.wire.name()
    }

    pub fn set_retries(&mut self, retries: Retries) {
        self.retries = retries;
    }

    /// Sets what computer and adapter may add to the time of an answer; 20 ms unless set.
    pub fn set_host_slack(&mut self, slack: Duration) {
        self.timing.host_slack = slack;
    }

    pub fn statistics(&self) -> Statistics {
        self.statistics
    }

    /// Time on the clock of the line.
    pub fn now(&self) -> Duration {
        self.wire.now()
    }

    /// Waits, and drops what comes meanwhile.
    pub fn wait(&mut self, time: Duration) -> Result<(), BusError> {
        let until = self.wire.now() + time;
        Ok(self.listen_until(until)?)
    }

    /// Waits until a moment of [`now`](Self::now).
    pub fn wait_until(&mut self, moment: Duration) -> Result<(), BusError> {
        Ok(self.listen_until(moment)?)
    }

    /// Talks at another speed from now on. What the servos are set to stays.
    pub fn set_baud(&mut self, bps: u32) -> Result<(), BusError> {
        self.wire.set_baud(bps)?;
        self.timing.bps = bps;
        self.silent.clear();
        // A servo of this speed heard noise before, and may wait for the rest of a frame.
        Ok(self.free_receivers()?)
    }

    /// Opens the port again after it was lost, such as by a pulled plug.
    pub fn reopen(&mut self) -> Result<(), BusError> {
        self.wire.reopen()?;
        self.silent.clear();
        Ok(())
    }
}

#[cfg(test)]
mod tests;
