//! Reads a joystick in a thread of its own, because the device has no time-out.

use std::{
    fs::File,
    io::{self, Read},
    path::{Path, PathBuf},
    sync::mpsc::{self, Receiver, TryRecvError},
    thread,
};

use super::{EVENT_BYTES, JoystickEvent, JoystickMap, JoystickState};
use crate::drive::Wish;

#[derive(Debug, thiserror::Error)]
pub enum JoystickError {
    #[error(
        "cannot open the joystick {path}: is it plugged in? `ls /dev/input/js*` lists those of this computer"
    )]
    Open { path: PathBuf, source: io::Error },
    #[error("the joystick is gone: is it still plugged in, or is its battery empty?")]
    Gone(#[source] io::Error),
}

/// A joystick that is plugged in.
pub struct Joystick {
    events: Receiver<io::Result<JoystickEvent>>,
    state: JoystickState,
}

impl Joystick {
    /// Opens a device such as `/dev/input/js0`, or a pipe that carries the same events.
    pub fn open(path: &Path, map: JoystickMap) -> Result<Self, JoystickError> {
        let mut device = File::open(path).map_err(|source| JoystickError::Open {
            path: path.to_owned(),
            source,
        })?;
        let (sender, events) = mpsc::channel();
        thread::spawn(move || {
            loop {
                let mut bytes = [0; EVENT_BYTES];
                let read = device.read_exact(&mut bytes);
                let is_last = read.is_err();
                let event = read.map(|()| JoystickEvent::decode(bytes));
                let sent = event.transpose().map_or(Ok(()), |event| sender.send(event));
                if is_last || sent.is_err() {
                    return;
                }
            }
        });
        Ok(Self {
            events,
            state: JoystickState::new(map),
        })
    }

    /// Returns what the user wants now. `note` gets the events since the last call.
    pub fn wish(&mut self, mut note: impl FnMut(JoystickEvent)) -> Result<Wish, JoystickError> {
        loop {
            match self.events.try_recv() {
                Ok(Ok(event)) => {
                    note(event);
                    self.state.take(event);
                }
                Ok(Err(error)) => return Err(JoystickError::Gone(error)),
                Err(TryRecvError::Empty) => return Ok(self.state.wish()),
                Err(TryRecvError::Disconnected) => {
                    return Err(JoystickError::Gone(io::ErrorKind::UnexpectedEof.into()));
                }
            }
        }
    }
}
