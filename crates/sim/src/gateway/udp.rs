//! The gateway as a UDP server.

use std::{
    io::{self, ErrorKind},
    net::{SocketAddr, UdpSocket},
};

use super::frame::LENGTH;

/// Datagrams taken in one call.
const DATAGRAMS: usize = 64;
/// Longest datagram that is read, more than Ethernet carries in one piece.
const LONGEST: usize = 2_048;
/// Most bytes of one datagram to the peer.
const BATCH: usize = 100 * LENGTH;

/// It answers whoever sent to it last.
pub struct UdpServer {
    socket: UdpSocket,
    peer: Option<SocketAddr>,
}

impl UdpServer {
    pub fn open(address: SocketAddr) -> io::Result<Self> {
        let socket = UdpSocket::bind(address)?;
        socket.set_nonblocking(true)?;
        Ok(Self { socket, peer: None })
    }

    pub fn address(&self) -> io::Result<SocketAddr> {
        self.socket.local_addr()
    }

    /// Takes datagrams that have arrived since the last call. Returns how many did not end with a whole frame.
    pub fn receive(&mut self, each: &mut dyn FnMut(&[u8; LENGTH])) -> u64 {
        let mut cut = 0;
        let mut bytes = [0; LONGEST];
        for _ in 0..DATAGRAMS {
            match self.socket.recv_from(&mut bytes) {
                Ok((count, sender)) => {
                    self.peer = Some(sender);
                    let (frames, rest) = bytes[..count].as_chunks();
                    frames.iter().for_each(&mut *each);
                    cut += u64::from(!rest.is_empty());
                }
                Err(e) if e.kind() == ErrorKind::WouldBlock => break,
                // Some systems report here that a former peer is gone.
                Err(_) => {}
            }
        }
        cut
    }

    /// Passes whole frames on, several in a datagram. Returns how many were taken and how many lost.
    pub fn send(&mut self, frames: &[u8]) -> (u64, u64) {
        let (mut taken, mut lost) = (0, 0);
        let Some(peer) = self.peer else {
            return (taken, lost);
        };
        for batch in frames.chunks(BATCH) {
            let counted = match self.socket.send_to(batch, peer) {
                Ok(_) => &mut taken,
                Err(_) => &mut lost,
            };
            *counted += (batch.len() / LENGTH) as u64;
        }
        (taken, lost)
    }
}
