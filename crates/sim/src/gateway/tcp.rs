//! The gateway as a TCP server.

use std::{
    collections::VecDeque,
    io::{self, ErrorKind, Read, Write},
    net::{SocketAddr, TcpListener, TcpStream},
};

use super::frame::LENGTH;

/// Clients at once, as many as gateways of this kind accept.
pub const CLIENTS: usize = 6;
/// Limit of bytes that wait for a client: 5,000 frames, half a second of a bus at full load.
const WAITING: usize = 5_000 * LENGTH;
/// Bytes taken from a client in one call, more than a bus carries in a millisecond.
const READ: usize = 4 * 1024;

pub struct TcpServer {
    listener: TcpListener,
    clients: Vec<Client>,
}

impl TcpServer {
    pub fn open(address: SocketAddr) -> io::Result<Self> {
        let listener = TcpListener::bind(address)?;
        listener.set_nonblocking(true)?;
        Ok(Self {
            listener,
            clients: Vec::new(),
        })
    }

    pub fn address(&self) -> io::Result<SocketAddr> {
        self.listener.local_addr()
    }

    /// Takes what clients have sent since the last call. A client that is gone is forgotten.
    pub fn receive(&mut self, each: &mut dyn FnMut(&[u8; LENGTH])) {
        self.accept();
        self.clients.retain_mut(|client| client.receive(each));
    }

    /// Accepts everyone who waits. Whoever comes while there is no place is turned away. A connection that fails before
    /// it is accepted concerns nobody else.
    fn accept(&mut self) {
        while let Ok((stream, _)) = self.listener.accept() {
            if self.clients.len() < CLIENTS
                && let Ok(client) = Client::new(stream)
            {
                self.clients.push(client);
            }
        }
    }

    /// Passes whole frames on to every client. Returns how many were taken and how many lost, over all clients.
    pub fn send(&mut self, frames: &[u8]) -> (u64, u64) {
        let (mut taken, mut lost) = (0, 0);
        self.clients.retain_mut(|client| {
            let queued = client.queue(frames);
            taken += queued;
            lost += (frames.len() / LENGTH) as u64 - queued;
            client.write()
        });
        (taken, lost)
    }
}

struct Client {
    stream: TcpStream,
    /// The beginning of a frame whose rest has not arrived.
    arrived: Vec<u8>,
    waiting: VecDeque<u8>,
}

impl Client {
    fn new(stream: TcpStream) -> io::Result<Self> {
        stream.set_nonblocking(true)?;
        stream.set_nodelay(true)?;
        Ok(Self {
            stream,
            arrived: Vec::new(),
            waiting: VecDeque::new(),
        })
    }

    /// False if the client is gone.
    fn receive(&mut self, each: &mut dyn FnMut(&[u8; LENGTH])) -> bool {
        let mut bytes = [0; READ];
        let count = match self.stream.read(&mut bytes) {
            Ok(0) => return false,
            Ok(count) => count,
            Err(e) => return may_go_on(&e),
        };
        self.arrived.extend_from_slice(&bytes[..count]);
        let (frames, rest) = self.arrived.as_chunks();
        frames.iter().for_each(each);
        self.arrived = rest.to_vec();
        true
    }

    /// Queues as many frames as have room and returns their number.
    fn queue(&mut self, frames: &[u8]) -> u64 {
        let room = WAITING.saturating_sub(self.waiting.len()) / LENGTH;
        let count = room.min(frames.len() / LENGTH);
        self.waiting.extend(&frames[..count * LENGTH]);
        count as u64
    }

    /// Writes what the connection accepts now. False if the client is gone.
    fn write(&mut self) -> bool {
        if self.waiting.is_empty() {
            return true;
        }
        match self.stream.write(self.waiting.make_contiguous()) {
            Ok(written) => {
                self.waiting.drain(..written);
                true
            }
            Err(e) => may_go_on(&e),
        }
    }
}

fn may_go_on(error: &io::Error) -> bool {
    matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::Interrupted)
}
