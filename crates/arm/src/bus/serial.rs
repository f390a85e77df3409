//! A serial port as the line to servos.

use std::{
    io::{self, ErrorKind},
    time::{Duration, Instant},
};

use serialport::{ClearBuffer, SerialPort};

use super::wire::{Wire, WireError};

/// A port takes a request within this time, unless nothing empties it.
const WRITE_TIME: Duration = Duration::from_secs(1);
/// Shortest time-out of a port. Windows refuses zero milliseconds.
const SHORTEST_WAIT: Duration = Duration::from_millis(if cfg!(windows) { 1 } else { 0 });

pub struct SerialWire {
    name: String,
    bps: u32,
    /// `None` after it was lost, so that it can be opened again.
    port: Option<Box<dyn SerialPort>>,
    opened: Instant,
}

impl SerialWire {
    /// Opens a port such as `/dev/ttyACM0` or `COM5`.
    pub fn open(name: &str, bps: u32) -> Result<Self, WireError> {
        let mut wire = Self {
            name: name.to_owned(),
            bps,
            port: None,
            opened: Instant::now(),
        };
        wire.reopen()?;
        Ok(wire)
    }

    fn with_port<T>(
        &mut self,
        act: impl FnOnce(&mut dyn SerialPort) -> io::Result<T>,
    ) -> Result<T, WireError> {
        let acted = match &mut self.port {
            Some(port) => act(port.as_mut()),
            None => Err(ErrorKind::NotConnected.into()),
        };
        acted.map_err(|source| {
            self.port = None;
            WireError::Lost {
                port: self.name.clone(),
                source,
            }
        })
    }
}

impl Wire for SerialWire {
    fn name(&self) -> &str {
        &self.name
    }

    fn now(&self) -> Duration {
        self.opened.elapsed()
    }

    fn send(&mut self, bytes: &[u8]) -> Result<(), WireError> {
        self.with_port(|port| {
            port.set_timeout(WRITE_TIME)?;
            port.write_all(bytes)
        })
    }

    fn receive(&mut self, buffer: &mut [u8], deadline: Duration) -> Result<usize, WireError> {
        let wait = deadline.saturating_sub(self.now()).max(SHORTEST_WAIT);
        self.with_port(|port| {
            port.set_timeout(wait)?;
            match port.read(buffer) {
                // A terminal that hangs up reads as its end.
                Ok(0) if !buffer.is_empty() => Err(ErrorKind::UnexpectedEof.into()),
                Ok(count) => Ok(count),
                Err(e) if matches!(e.kind(), ErrorKind::TimedOut | ErrorKind::Interrupted) => Ok(0),
                Err(e) => Err(e),
            }
        })
    }

    fn set_baud(&mut self, bps: u32) -> Result<(), WireError> {
        self.bps = bps;
        self.with_port(|port| port.set_baud_rate(bps).map_err(Into::into))
    }

    fn reopen(&mut self) -> Result<(), WireError> {
        // A port that is still open would be found in use.
        self.port = None;
        let port =
            robot_serial_port::open(&self.name, self.bps).map_err(|why| WireError::Open {
                port: self.name.clone(),
                why,
            })?;
        self.port = Some(port);
        // What came before is old.
        self.with_port(|port| port.clear(ClearBuffer::Input).map_err(Into::into))
    }
}
