//! One receive FIFO of three frames and CAN_RFxR (RM0090 32.7.3).

use std::collections::VecDeque;

const DEPTH: usize = 3;

mod rfr {
    pub const FULL: u32 = 1 << 3;
    pub const FOVR: u32 = 1 << 4;
    pub const RFOM: u32 = 1 << 5;
}

/// A frame in the registers RIxR, RDTxR, RDLxR and RDHxR.
pub type Received = [u32; 4];

#[derive(Debug, Default)]
pub struct Fifo {
    frames: VecDeque<Received>,
    full: bool,
    overrun: bool,
    /// The output mailbox keeps its last frame after the release.
    released: Received,
}

impl Fifo {
    /// Stores a frame. In a full FIFO it replaces the newest one, or is lost if `locked` (RFLM).
    pub fn push(&mut self, frame: Received, locked: bool) {
        if self.frames.len() < DEPTH {
            self.frames.push_back(frame);
        } else {
            self.overrun = true;
            if let Some(newest) = self.frames.back_mut().filter(|_| !locked) {
                *newest = frame;
            }
        }
        self.full |= self.frames.len() == DEPTH;
    }

    /// CAN_RFxR.
    pub fn status(&self) -> u32 {
        self.frames.len() as u32
            | if self.full { rfr::FULL } else { 0 }
            | if self.overrun { rfr::FOVR } else { 0 }
    }

    pub fn write_status(&mut self, value: u32) {
        self.full &= value & rfr::FULL == 0;
        self.overrun &= value & rfr::FOVR == 0;
        if value & rfr::RFOM != 0 {
            if let Some(frame) = self.frames.pop_front() {
                self.released = frame;
            }
            self.full = false;
        }
    }

    /// The output mailbox.
    pub fn front(&self) -> Received {
        self.frames.front().copied().unwrap_or(self.released)
    }

    /// Message pending, full, overrun: in the order of their enables in CAN_IER.
    pub fn interrupt_flags(&self) -> u32 {
        u32::from(!self.frames.is_empty())
            | u32::from(self.full) << 1
            | u32::from(self.overrun) << 2
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fourth_frame_replaces_the_third_or_is_lost() {
        for (locked, third) in [(false, 4), (true, 3)] {
            let mut fifo = Fifo::default();
            for n in 1..=4 {
                fifo.push([n; 4], locked);
            }
            // FMP = 3, FULL, FOVR.
            assert_eq!(fifo.status(), 3 | 1 << 3 | 1 << 4);
            fifo.write_status(1 << 5);
            fifo.write_status(1 << 5);
            assert_eq!(fifo.front()[0], third);
            assert_eq!(fifo.status(), 1 | 1 << 4);
            fifo.write_status(1 << 4);
            assert_eq!(fifo.status(), 1);
        }
    }
}
