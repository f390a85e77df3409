//! Sends a block of the black box: seven bytes a frame, after a number that counts up from 0.
//!
//! Frames are sent in ticks without a reply, one a tick, as those of a recording are.

use super::{TuningPort, identifiers::BLOCK_ID};
use crate::{black_box::BlackBoxMemory, domain::CanFrame};

/// A frame of a block, as received by the PC.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BlockFrame {
    /// Number within the block, from 0.
    pub number: u8,
    /// The bytes. Those beyond the end of the bank are 0.
    pub bytes: [u8; Self::BYTES],
}

impl BlockFrame {
    /// Bytes in a frame.
    pub const BYTES: usize = 7;

    /// Decodes a frame. Returns `None` for any other frame.
    pub fn decode(frame: &CanFrame) -> Option<Self> {
        if frame.id() != BLOCK_ID {
            return None;
        }
        let [number, bytes @ ..] = frame.full_payload()?;
        Some(Self { number, bytes })
    }

    fn encode(self) -> CanFrame {
        let [a, b, c, d, e, f, g] = self.bytes;
        CanFrame::new(BLOCK_ID, [self.number, a, b, c, d, e, f, g])
    }
}

#[derive(Clone, Copy, Debug)]
struct Running {
    port: TuningPort,
    bank: u8,
    /// The byte to send next.
    at: u16,
    number: u8,
    frames: u8,
}

/// Sends a block after it has been started.
#[derive(Clone, Debug, Default)]
pub struct BlockSender {
    running: Option<Running>,
}

impl BlockSender {
    /// Starts a block of so many frames and ends any other.
    pub(super) fn start(&mut self, port: TuningPort, bank: u8, at: u16, frames: u8) {
        self.running = (frames != 0).then_some(Running {
            port,
            bank,
            at,
            number: 0,
            frames,
        });
    }

    /// Whether a block is being sent.
    pub const fn is_running(&self) -> bool {
        self.running.is_some()
    }

    /// Ends the block.
    pub fn stop(&mut self) {
        self.running = None;
    }

    /// Returns the next frame. Called in each tick without a reply while a block is being sent.
    #[cold]
    #[inline(never)]
    pub fn next(&mut self, memory: &BlackBoxMemory) -> Option<(TuningPort, CanFrame)> {
        let running = self.running.as_mut()?;
        let bytes = core::array::from_fn(|offset| {
            let at = usize::from(running.at).saturating_add(offset);
            memory.byte(running.bank.into(), at)
        });
        let frame = BlockFrame {
            number: running.number,
            bytes,
        };
        let port = running.port;
        running.number = running.number.saturating_add(1);
        running.at = running.at.saturating_add(BlockFrame::BYTES as u16);
        if running.number == running.frames {
            self.running = None;
        }
        Some((port, frame.encode()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{black_box::BANK_BYTES, domain::BusId};

    fn memory() -> Box<BlackBoxMemory> {
        let memory = Box::<BlackBoxMemory>::default();
        let bytes: Vec<u8> = (0..BANK_BYTES).map(|at| (at % 251) as u8).collect();
        memory.fill(1, &bytes);
        memory
    }

    #[test]
    fn a_block_is_sent_in_order_and_ends() {
        let memory = memory();
        let mut sender = BlockSender::default();
        assert_eq!(sender.next(&memory), None);
        sender.start(TuningPort::Bus(BusId::Can2), 1, 250, 2);
        let (port, first) = sender.next(&memory).expect("a frame");
        assert_eq!(port, TuningPort::Bus(BusId::Can2));
        assert_eq!(first.id().raw(), 0x7A6);
        assert_eq!(first.payload(), [0, 250, 0, 1, 2, 3, 4, 5]);
        assert!(sender.is_running());
        let (_, second) = sender.next(&memory).expect("a frame");
        let second = BlockFrame::decode(&second).expect("a frame of a block");
        assert_eq!((second.number, second.bytes), (1, [6, 7, 8, 9, 10, 11, 12]));
        assert!(!sender.is_running());
        assert_eq!(sender.next(&memory), None);
    }

    /// The last byte of a bank is number 14,335 = 57 · 251 + 28.
    #[test]
    fn there_are_zeros_beyond_the_end() {
        let memory = memory();
        let mut sender = BlockSender::default();
        sender.start(TuningPort::Link, 1, 14_334, 1);
        let (_, frame) = sender.next(&memory).expect("a frame");
        assert_eq!(frame.payload(), [0, 27, 28, 0, 0, 0, 0, 0]);
    }
}
