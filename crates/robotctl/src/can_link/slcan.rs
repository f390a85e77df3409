//! A LAWICEL adapter on a serial device.

use std::{
    collections::VecDeque,
    io::{ErrorKind, Read, Write},
    time::{Duration, Instant},
};

use robot_app::{
    domain::CanFrame,
    link::{BAUD, Heard, PcReceiver},
};
use serialport::SerialPort;

use super::{
    CanLink, CanLinkError,
    lawicel::{self, LineParser, Received},
};

/// Speed of the serial port. USB adapters and pseudo-terminals ignore it.
const LINE_BPS: u32 = 115_200;
/// Silence for this long counts as acceptance, because some adapters do not answer commands.
const ANSWER_TIME: Duration = Duration::from_millis(300);
/// Bytes that arrive within this time after the channel was closed are dropped.
const SETTLE_TIME: Duration = Duration::from_millis(100);
const BIT_RATE_1M: &str = "S8\r";
const OPEN: &str = "O\r";
const CLOSE: &str = "C\r";
/// A serial port as this system names it.
#[cfg(not(target_os = "linux"))]
pub(super) const EXAMPLE_PORT: &str = if cfg!(windows) {
    "COM3"
} else {
    "/dev/cu.usbmodem1101"
};
/// Shortest time-out of a port. Windows refuses zero milliseconds.
const SHORTEST_WAIT: Duration = Duration::from_millis(1);

pub(super) struct Slcan {
    port: Box<dyn SerialPort>,
    parser: LineParser,
    received: VecDeque<Received>,
    name: String,
    bytes: u64,
    /// The adapter has said something that an slcan adapter says.
    is_understood: bool,
    /// A byte came that no slcan adapter says.
    is_foreign: bool,
}

impl Slcan {
    /// Opens the adapter's channel at 1 Mbit/s. It closes the channel first, as it may be open.
    pub fn open(name: &str) -> Result<Self, CanLinkError> {
        let port = robot_serial_port::open(name, LINE_BPS).map_err(|why| CanLinkError::Open {
            device: name.to_owned(),
            why,
        })?;
        let mut link = Self {
            port,
            parser: LineParser::default(),
            received: VecDeque::new(),
            name: name.to_owned(),
            bytes: 0,
            is_understood: false,
            is_foreign: false,
        };
        // The empty line ends a line that another program may have left unfinished.
        link.port.write_all(b"\r")?;
        link.port.write_all(CLOSE.as_bytes())?;
        let settled = Instant::now() + SETTLE_TIME;
        while link.next(settled)?.is_some() {}
        if link.is_foreign && link.speaks_pc_link()? {
            return Err(CanLinkError::SpeaksPcLink {
                device: link.name.clone(),
            });
        }
        link.command(BIT_RATE_1M)?;
        link.command(OPEN)?;
        Ok(link)
    }

    /// Listens at the PC link's speed for the robot's state. One state may be there by chance.
    fn speaks_pc_link(&mut self) -> Result<bool, CanLinkError> {
        let port = &mut self.port;
        port.set_baud_rate(BAUD).map_err(std::io::Error::from)?;
        let mut link = PcReceiver::new();
        let mut states = 0;
        let until = Instant::now() + SETTLE_TIME;
        while states < 2 && Instant::now() < until {
            let mut bytes = [0; 4096];
            port.set_timeout(SETTLE_TIME)
                .map_err(std::io::Error::from)?;
            let count = match port.read(&mut bytes) {
                Ok(count) => count,
                Err(e) if matches!(e.kind(), ErrorKind::TimedOut | ErrorKind::Interrupted) => 0,
                Err(e) => return Err(e.into()),
            };
            link.feed(&bytes[..count], |heard| {
                states += u32::from(matches!(heard, Heard::Uplink(_)));
            });
        }
        port.set_baud_rate(LINE_BPS).map_err(std::io::Error::from)?;
        Ok(states >= 2)
    }

    fn command(&mut self, command: &'static str) -> Result<(), CanLinkError> {
        self.port.write_all(command.as_bytes())?;
        let deadline = Instant::now() + ANSWER_TIME;
        loop {
            match self.next(deadline)? {
                Some(Received::Done) | None => return Ok(()),
                Some(Received::Frame(_)) => {}
                Some(Received::Refused) => {
                    return Err(CanLinkError::SetUp {
                        device: self.name.clone(),
                        command: command.trim_end(),
                    });
                }
            }
        }
    }

    fn next(&mut self, deadline: Instant) -> Result<Option<Received>, CanLinkError> {
        loop {
            if let Some(received) = self.received.pop_front() {
                return Ok(Some(received));
            }
            let left = deadline.saturating_duration_since(Instant::now());
            if left.is_zero() {
                return Ok(None);
            }
            self.read(left)?;
        }
    }

    fn read(&mut self, at_most: Duration) -> Result<(), CanLinkError> {
        let mut bytes = [0; 4096];
        self.port
            .set_timeout(at_most.max(SHORTEST_WAIT))
            .map_err(std::io::Error::from)?;
        match self.port.read(&mut bytes) {
            Ok(count) => {
                let said = bytes[..count].iter();
                let before = self.received.len();
                self.received
                    .extend(said.filter_map(|byte| self.parser.feed(*byte)));
                self.bytes += count as u64;
                self.is_understood |= self.received.len() > before;
                self.is_foreign |= !bytes[..count].is_ascii();
                Ok(())
            }
            Err(e) if matches!(e.kind(), ErrorKind::TimedOut | ErrorKind::Interrupted) => Ok(()),
            Err(e) => Err(e.into()),
        }
    }
}

impl CanLink for Slcan {
    fn send(&mut self, frame: &CanFrame) -> Result<(), CanLinkError> {
        Ok(self.port.write_all(lawicel::transmit(frame).as_bytes())?)
    }

    fn receive(&mut self, deadline: Instant) -> Result<Option<CanFrame>, CanLinkError> {
        loop {
            match self.next(deadline)? {
                Some(Received::Frame(frame)) => return Ok(Some(frame)),
                Some(Received::Refused) => {
                    return Err(CanLinkError::FrameRefused {
                        device: self.name.clone(),
                    });
                }
                Some(Received::Done) => {}
                None => return Ok(None),
            }
        }
    }

    fn why_silent(&self) -> String {
        why_silent(&self.name, self.bytes, self.is_understood)
    }
}

/// Says what may be wrong if the robot does not answer, given the bytes that came from the port.
fn why_silent(name: &str, bytes: u64, is_understood: bool) -> String {
    if bytes == 0 {
        format!(
            "{name} says nothing at all: is it an slcan adapter, and is the bus connected, at 1 Mbit/s and terminated, \
             and the robot on?"
        )
    } else if is_understood {
        format!(
            "the adapter at {name} works: is the robot on, is this one of its two CAN buses at 1 Mbit/s, and is the bus \
             terminated?"
        )
    } else {
        format!(
            "{bytes} bytes came from {name}, but none as an slcan adapter says them: is it the PC link (--link {name}), \
             or another device?"
        )
    }
}

impl Drop for Slcan {
    fn drop(&mut self) {
        // The adapter may be gone; then there is nothing to close.
        let _ = self.port.write_all(CLOSE.as_bytes());
    }
}

#[cfg(test)]
mod tests {
    use super::why_silent;

    /// A user may name the port of the PC link.
    #[test]
    fn silence_is_explained_by_what_the_port_said() {
        assert!(why_silent("COM3", 0, false).contains("nothing at all"));
        assert!(why_silent("COM3", 940, false).contains("--link COM3"));
        assert!(why_silent("COM3", 12, true).contains("works"));
    }
}
