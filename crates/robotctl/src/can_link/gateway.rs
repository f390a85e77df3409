//! A gateway between CAN and Ethernet that puts each frame into 13 bytes: Waveshare 2-CH-CAN-TO-ETH, USR-CANET200, Ebyte
//! E810 and others like them.

mod address;
mod frame;
mod tcp;
mod udp;

use std::{
    collections::VecDeque,
    io::{self, ErrorKind},
    time::{Duration, Instant},
};

use robot_app::domain::CanFrame;

use super::{CanLink, CanLinkError};
use address::Protocol;
pub use address::{GatewayAddress, GatewayAddressError};
use frame::LENGTH;
use tcp::TcpGateway;
use udp::UdpGateway;

/// A connection that carries frames of 13 bytes.
trait Connection {
    fn write(&mut self, frame: &[u8; LENGTH]) -> io::Result<()>;

    /// Waits for frames and appends them.
    fn read(&mut self, at_most: Duration, into: &mut Vec<[u8; LENGTH]>) -> io::Result<()>;
}

/// A CAN bus behind a gateway.
pub(super) struct Gateway {
    address: GatewayAddress,
    connection: Box<dyn Connection>,
    received: VecDeque<CanFrame>,
}

impl Gateway {
    pub fn open(address: &GatewayAddress) -> Result<Self, CanLinkError> {
        let opened = address.resolve().and_then(|places| {
            let connection: Box<dyn Connection> = match address.protocol {
                Protocol::Tcp => Box::new(TcpGateway::connect(&places)?),
                Protocol::Udp => Box::new(UdpGateway::connect(&places)?),
            };
            Ok(connection)
        });
        Ok(Self {
            address: address.clone(),
            connection: opened.map_err(|error| address.failed(&error))?,
            received: VecDeque::new(),
        })
    }

    fn read(&mut self, at_most: Duration) -> io::Result<()> {
        let mut frames = Vec::new();
        match self.connection.read(at_most, &mut frames) {
            Err(e) if !is_silence(&e) => return Err(e),
            Ok(()) | Err(_) => {}
        }
        self.received
            .extend(frames.iter().filter_map(frame::decode));
        Ok(())
    }
}

/// True if nothing has arrived before the time-out, which systems name differently.
fn is_silence(error: &io::Error) -> bool {
    matches!(
        error.kind(),
        ErrorKind::TimedOut | ErrorKind::WouldBlock | ErrorKind::Interrupted
    )
}

impl CanLink for Gateway {
    fn send(&mut self, frame: &CanFrame) -> Result<(), CanLinkError> {
        let written = self.connection.write(&frame::encode(frame));
        written.map_err(|error| self.address.failed(&error))
    }

    fn receive(&mut self, deadline: Instant) -> Result<Option<CanFrame>, CanLinkError> {
        loop {
            if let Some(frame) = self.received.pop_front() {
                return Ok(Some(frame));
            }
            let left = deadline.saturating_duration_since(Instant::now());
            if left.is_zero() {
                return Ok(None);
            }
            self.read(left)
                .map_err(|error| self.address.failed(&error))?;
        }
    }

    fn why_silent(&self) -> String {
        self.address.why_silent()
    }
}

#[cfg(test)]
mod tests;
