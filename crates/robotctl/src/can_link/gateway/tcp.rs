//! A gateway that is a TCP server.

use std::{
    io::{self, ErrorKind, Read, Write},
    net::{SocketAddr, TcpStream},
    time::Duration,
};

use super::{Connection, frame::LENGTH};

/// A gateway in the same network answers within milliseconds.
const CONNECT_TIME: Duration = Duration::from_secs(3);
/// The gateway takes frames much faster unless it hangs.
const WRITE_TIME: Duration = Duration::from_secs(1);

pub struct TcpGateway {
    stream: TcpStream,
    /// The beginning of a frame whose rest has not arrived.
    arrived: Vec<u8>,
}

impl TcpGateway {
    /// Connects to the first of the places that accepts.
    pub fn connect(places: &[SocketAddr]) -> io::Result<Self> {
        let mut failed = io::Error::from(ErrorKind::AddrNotAvailable);
        for place in places {
            match TcpStream::connect_timeout(place, CONNECT_TIME) {
                Ok(stream) => return Self::new(stream),
                Err(error) => failed = error,
            }
        }
        Err(failed)
    }

    fn new(stream: TcpStream) -> io::Result<Self> {
        stream.set_nodelay(true)?;
        stream.set_write_timeout(Some(WRITE_TIME))?;
        Ok(Self {
            stream,
            arrived: Vec::new(),
        })
    }
}

impl Connection for TcpGateway {
    fn write(&mut self, frame: &[u8; LENGTH]) -> io::Result<()> {
        self.stream.write_all(frame)
    }

    fn read(&mut self, at_most: Duration, into: &mut Vec<[u8; LENGTH]>) -> io::Result<()> {
        let mut bytes = [0; 4096];
        self.stream.set_read_timeout(Some(at_most))?;
        let count = self.stream.read(&mut bytes)?;
        if count == 0 {
            return Err(ErrorKind::UnexpectedEof.into());
        }
        self.arrived.extend_from_slice(&bytes[..count]);
        let (frames, rest) = self.arrived.as_chunks();
        into.extend_from_slice(frames);
        self.arrived = rest.to_vec();
        Ok(())
    }
}
