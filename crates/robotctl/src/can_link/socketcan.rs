//! A CAN interface of the Linux kernel.

use std::{
    io::{Error, ErrorKind},
    time::{Duration, Instant},
};

use robot_app::domain::{CanFrame, StandardId};
use socketcan::{CanDataFrame, CanFrame as SocketFrame, CanSocket, EmbeddedFrame, Id, Socket};

use super::{CanLink, CanLinkError};

pub(super) struct Interface {
    socket: CanSocket,
}

impl Interface {
    /// Opens an interface that is up.
    pub fn open(name: &str) -> Result<Self, CanLinkError> {
        let opened = CanSocket::open(name).map_err(|e| CanLinkError::Open {
            device: name.to_owned(),
            why: format!("{e}; is it up? `sudo ip link set {name} up type can bitrate 1000000`"),
        })?;
        Ok(Self { socket: opened })
    }
}

impl CanLink for Interface {
    fn send(&mut self, frame: &CanFrame) -> Result<(), CanLinkError> {
        let id = socketcan::StandardId::new(frame.id().raw());
        let frame = id.and_then(|id| CanDataFrame::new(id, frame.payload()));
        let frame = frame.ok_or_else(|| Error::from(ErrorKind::InvalidInput))?;
        Ok(self.socket.write_frame(&frame)?)
    }

    fn receive(&mut self, deadline: Instant) -> Result<Option<CanFrame>, CanLinkError> {
        loop {
            let left = deadline.saturating_duration_since(Instant::now());
            if left < Duration::from_millis(1) {
                return Ok(None);
            }
            match self.socket.read_frame_timeout(left) {
                Ok(heard) => {
                    if let Some(frame) = standard_data(&heard) {
                        return Ok(Some(frame));
                    }
                }
                Err(e) if matches!(e.kind(), ErrorKind::TimedOut | ErrorKind::WouldBlock) => {
                    return Ok(None);
                }
                Err(e) => return Err(e.into()),
            }
        }
    }
}

/// Returns `None` for the kinds of frames that a link ignores.
fn standard_data(heard: &SocketFrame) -> Option<CanFrame> {
    let (SocketFrame::Data(frame), Id::Standard(id)) = (heard, heard.id()) else {
        return None;
    };
    CanFrame::from_payload(StandardId::new(id.as_raw())?, frame.data())
}
