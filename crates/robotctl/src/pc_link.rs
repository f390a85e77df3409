//! Reaches the robot through the PC link (docs/pc-link.md): its state, commands to its motors, and the tuning channel.

mod plausible;
mod receiver;

use std::{
    cell::RefCell,
    collections::VecDeque,
    io::{ErrorKind, Read, Write},
    rc::Rc,
    time::{Duration, Instant},
};

use robot_app::{
    domain::CanFrame,
    link::{BAUD, Downlink, DriveFrame, Heard, ScanCounters, Tunnelled},
};
use serialport::{ClearBuffer, SerialPort};

use crate::can_link::{CanLink, CanLinkError};
use plausible::is_plausible;
use receiver::Receiver;

/// A port takes a frame within this time, unless nothing empties it.
const WRITE_TIME: Duration = Duration::from_secs(1);
/// Shortest time-out of a port. Windows refuses zero milliseconds.
const SHORTEST_WAIT: Duration = Duration::from_millis(1);

/// The serial port at which the robot's link is.
pub struct PcLink {
    name: String,
    port: Box<dyn SerialPort>,
    receiver: Receiver,
    heard: VecDeque<Heard>,
    traffic: Traffic,
}

/// What came through the port so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Traffic {
    pub bytes: u64,
    /// Frames with the robot's state.
    pub states: u64,
    /// Frames with values that no robot sends. They were damaged, and their CRC fits by chance.
    pub implausible: u64,
    /// Damage before the first good frame is not counted, as the port is opened in the middle of one.
    pub counters: ScanCounters,
}

impl PcLink {
    pub fn open(name: &str) -> Result<Self, CanLinkError> {
        let port = robot_serial_port::open(name, BAUD).map_err(|why| CanLinkError::Open {
            device: name.to_owned(),
            why,
        })?;
        // What came before is old.
        let cleared = port.clear(ClearBuffer::Input);
        cleared.map_err(|error| lost(name, error.into()))?;
        Ok(Self {
            name: name.to_owned(),
            port,
            receiver: Receiver::default(),
            heard: VecDeque::new(),
            traffic: Traffic::default(),
        })
    }

    /// Returns the next frame from the robot, or `None` if there is none before `deadline`.
    pub fn next(&mut self, deadline: Instant) -> Result<Option<Heard>, CanLinkError> {
        loop {
            if let Some(heard) = self.heard.pop_front() {
                return Ok(Some(heard));
            }
            let left = deadline.saturating_duration_since(Instant::now());
            if left.is_zero() {
                return Ok(None);
            }
            self.read(left)?;
        }
    }

    /// Sends a command to the motors.
    pub fn command(&mut self, command: &Downlink) -> Result<(), CanLinkError> {
        self.write(&command.encode())
    }

    /// Sends a command in place of the sticks.
    pub fn drive(&mut self, frame: &DriveFrame) -> Result<(), CanLinkError> {
        self.write(&frame.encode())
    }

    pub fn traffic(&self) -> Traffic {
        Traffic {
            counters: self.receiver.counters(),
            ..self.traffic
        }
    }

    fn write(&mut self, bytes: &[u8]) -> Result<(), CanLinkError> {
        let set = self.port.set_timeout(WRITE_TIME);
        let written = set
            .map_err(Into::into)
            .and_then(|()| self.port.write_all(bytes));
        written.map_err(|error| lost(&self.name, error))
    }

    fn read(&mut self, at_most: Duration) -> Result<(), CanLinkError> {
        let mut bytes = [0; 4096];
        let set = self.port.set_timeout(at_most.max(SHORTEST_WAIT));
        set.map_err(|error| lost(&self.name, error.into()))?;
        let count = match self.port.read(&mut bytes) {
            Ok(count) => count,
            Err(e) if matches!(e.kind(), ErrorKind::TimedOut | ErrorKind::Interrupted) => 0,
            Err(e) => return Err(lost(&self.name, e)),
        };
        let Self {
            receiver,
            heard,
            traffic,
            ..
        } = self;
        traffic.bytes += count as u64;
        receiver.feed(&bytes[..count], |frame| {
            match &frame {
                Heard::Uplink(state) if !is_plausible(state) => {
                    traffic.implausible += 1;
                    return;
                }
                Heard::Uplink(_) => traffic.states += 1,
                Heard::Tunnel(_) => {}
            }
            heard.push_back(frame);
        });
        Ok(())
    }
}

fn lost(name: &str, source: std::io::Error) -> CanLinkError {
    CanLinkError::PortFailed {
        device: name.to_owned(),
        source,
    }
}

/// The tuning channel of the robot.
impl CanLink for PcLink {
    fn send(&mut self, frame: &CanFrame) -> Result<(), CanLinkError> {
        match Tunnelled::new(*frame) {
            Some(tunnelled) => self.write(&tunnelled.encode()),
            None => Err(CanLinkError::NotTunnelled {
                id: frame.id().raw(),
            }),
        }
    }

    fn receive(&mut self, deadline: Instant) -> Result<Option<CanFrame>, CanLinkError> {
        while let Some(heard) = self.next(deadline)? {
            if let Heard::Tunnel(frame) = heard {
                return Ok(Some(frame));
            }
        }
        Ok(None)
    }

    fn why_silent(&self) -> String {
        why_silent(&self.name, &self.traffic())
    }
}

/// A link with a second user, who has it while a tuning client asks for settings.
#[derive(Clone)]
pub struct SharedLink(pub Rc<RefCell<PcLink>>);

impl CanLink for SharedLink {
    fn send(&mut self, frame: &CanFrame) -> Result<(), CanLinkError> {
        self.0.borrow_mut().send(frame)
    }

    fn receive(&mut self, deadline: Instant) -> Result<Option<CanFrame>, CanLinkError> {
        self.0.borrow_mut().receive(deadline)
    }

    fn why_silent(&self) -> String {
        CanLink::why_silent(&*self.0.borrow())
    }
}

/// Says what may be wrong if the robot does not answer.
pub fn why_silent(name: &str, traffic: &Traffic) -> String {
    let Traffic {
        bytes,
        states,
        implausible,
        counters,
    } = traffic;
    if *bytes == 0 {
        format!(
            "nothing comes from {name}: is the robot on, is this the adapter at UART2 of the C board, and do ground, TX \
             to RX and RX to TX connect the two (docs/pc-link.md)? Or is it an slcan adapter: --can {name}?"
        )
    } else if counters.good == 0 {
        format!(
            "{bytes} bytes came from {name}, but no frame of the robot: does its line not have {BAUD} baud, 8N1 and \
             3.3 V, or is another device there, such as an slcan adapter (--can {name})?"
        )
    } else if *states == 0 && *implausible > 0 {
        format!(
            "{name} brings states with values that no robot sends: does another program have it open, or is the line noisy?"
        )
    } else if *states == 0 {
        format!("{name} carries tunnelled frames, but not the robot's state: is a robot there?")
    } else {
        format!(
            "{name} brings the robot's state, but no answer: is the adapter's TX connected to the board's RX, and is \
             the firmware as new as this robotctl?"
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn silence_is_explained_by_what_was_heard() {
        let mut traffic = Traffic::default();
        let nothing = why_silent("COM4", &traffic);
        assert!(nothing.starts_with("nothing comes from COM4"), "{nothing}");
        assert!(nothing.contains("--can COM4"), "{nothing}");
        traffic.bytes = 7;
        assert!(why_silent("COM4", &traffic).contains("460800 baud"));
        traffic.counters.good = 1;
        traffic.states = 1;
        assert!(why_silent("COM4", &traffic).contains("adapter's TX"));
    }
}
