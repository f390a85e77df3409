//! A gateway that sends datagrams to whoever sent to it last.

use std::{
    io::{self, ErrorKind},
    net::{Ipv4Addr, Ipv6Addr, SocketAddr, UdpSocket},
    time::Duration,
};

use super::{Connection, frame::LENGTH};

/// Longest datagram that is read, more than Ethernet carries in one piece.
const LONGEST: usize = 2_048;

pub struct UdpGateway(UdpSocket);

impl UdpGateway {
    /// Makes itself known by an empty datagram, so that frames of the bus arrive before the first frame is sent.
    pub fn connect(places: &[SocketAddr]) -> io::Result<Self> {
        let &gateway = places.first().ok_or(ErrorKind::AddrNotAvailable)?;
        let any: SocketAddr = match gateway {
            SocketAddr::V4(_) => (Ipv4Addr::UNSPECIFIED, 0).into(),
            SocketAddr::V6(_) => (Ipv6Addr::UNSPECIFIED, 0).into(),
        };
        let socket = UdpSocket::bind(any)?;
        socket.connect(gateway)?;
        socket.send(&[])?;
        Ok(Self(socket))
    }
}

impl Connection for UdpGateway {
    fn write(&mut self, frame: &[u8; LENGTH]) -> io::Result<()> {
        self.0.send(frame).map(drop)
    }

    fn read(&mut self, at_most: Duration, into: &mut Vec<[u8; LENGTH]>) -> io::Result<()> {
        let mut bytes = [0; LONGEST];
        self.0.set_read_timeout(Some(at_most))?;
        let count = self.0.recv(&mut bytes)?;
        let (frames, _) = bytes[..count].as_chunks();
        into.extend_from_slice(frames);
        Ok(())
    }
}
