//! A LAWICEL adapter on a serial device.

use std::{
    collections::VecDeque,
    io::{ErrorKind, Read, Write},
    path::Path,
    time::{Duration, Instant},
};

use robot_app::domain::CanFrame;
use serialport::SerialPort;

use super::{
    CanLink, CanLinkError,
    lawicel::{self, Heard, Listener},
};

/// USB adapters and pseudo-terminals ignore it.
const LINE_BPS: u32 = 115_200;
/// Some adapters do not answer commands; silence for so long is taken for yes.
const ANSWER_TIME: Duration = Duration::from_millis(300);
/// After closing the channel, what was still on its way is dropped.
const SETTLE_TIME: Duration = Duration::from_millis(100);
const BIT_RATE_1M: &str = "S8\r";
const OPEN: &str = "O\r";
const CLOSE: &str = "C\r";

pub(super) struct Slcan {
    port: Box<dyn SerialPort>,
    listener: Listener,
    heard: VecDeque<Heard>,
}

impl Slcan {
    /// Opens the adapter's channel at 1 Mbit/s, after closing it should it be open.
    pub fn open(device: &Path) -> Result<Self, CanLinkError> {
        let name = device.to_string_lossy();
        let port = serialport::new(name.as_ref(), LINE_BPS)
            .open()
            .map_err(|e| CanLinkError::Open {
                device: name.into_owned(),
                why: format!("{e}; {}", cure(&e)),
            })?;
        let mut link = Self {
            port,
            listener: Listener::default(),
            heard: VecDeque::new(),
        };
        // The empty line ends whatever was left half-written.
        link.port.write_all(b"\r")?;
        link.port.write_all(CLOSE.as_bytes())?;
        let settled = Instant::now() + SETTLE_TIME;
        while link.next(settled)?.is_some() {}
        link.command(BIT_RATE_1M)?;
        link.command(OPEN)?;
        Ok(link)
    }

    fn command(&mut self, command: &'static str) -> Result<(), CanLinkError> {
        self.port.write_all(command.as_bytes())?;
        let deadline = Instant::now() + ANSWER_TIME;
        loop {
            match self.next(deadline)? {
                Some(Heard::Done) | None => return Ok(()),
                Some(Heard::Frame(_)) => {}
                Some(Heard::Refused) => {
                    let command = command.trim_end();
                    return Err(CanLinkError::SetUp { command });
                }
            }
        }
    }

    fn next(&mut self, deadline: Instant) -> Result<Option<Heard>, CanLinkError> {
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

    fn read(&mut self, at_most: Duration) -> Result<(), CanLinkError> {
        let mut bytes = [0; 4096];
        self.port
            .set_timeout(at_most)
            .map_err(std::io::Error::from)?;
        match self.port.read(&mut bytes) {
            Ok(count) => {
                let said = bytes[..count].iter();
                self.heard
                    .extend(said.filter_map(|byte| self.listener.feed(*byte)));
                Ok(())
            }
            Err(e) if matches!(e.kind(), ErrorKind::TimedOut | ErrorKind::Interrupted) => Ok(()),
            Err(e) => Err(e.into()),
        }
    }
}

/// What to do about a port that cannot be opened.
fn cure(error: &serialport::Error) -> String {
    if error.kind() == serialport::ErrorKind::Io(ErrorKind::PermissionDenied) {
        return if cfg!(windows) {
            "another program has it open".to_owned()
        } else {
            "add yourself to its group, often `sudo usermod -aG dialout $USER`, and log in again"
                .to_owned()
        };
    }
    let ports = serialport::available_ports().unwrap_or_default();
    let names: Vec<String> = ports.into_iter().map(|port| port.port_name).collect();
    if names.is_empty() {
        "this computer has no serial port: is the adapter plugged in?".to_owned()
    } else {
        format!("serial ports here: {}", names.join(", "))
    }
}

impl CanLink for Slcan {
    fn send(&mut self, frame: &CanFrame) -> Result<(), CanLinkError> {
        Ok(self.port.write_all(lawicel::transmit(frame).as_bytes())?)
    }

    fn receive(&mut self, deadline: Instant) -> Result<Option<CanFrame>, CanLinkError> {
        loop {
            match self.next(deadline)? {
                Some(Heard::Frame(frame)) => return Ok(Some(frame)),
                Some(Heard::Refused) => return Err(CanLinkError::FrameRefused),
                Some(Heard::Done) => {}
                None => return Ok(None),
            }
        }
    }
}

impl Drop for Slcan {
    fn drop(&mut self) {
        // The adapter may be gone; then there is nothing to close.
        let _ = self.port.write_all(CLOSE.as_bytes());
    }
}
