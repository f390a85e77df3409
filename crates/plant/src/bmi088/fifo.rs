//! The gyro die's buffer of past samples (datasheet chapters 4.9.2 and 5.5): headerless frames of six bytes.

use std::collections::VecDeque;

const FRAMES: usize = 100;
const FRAME_LEN: usize = 6;
const OVERRUN: u8 = 1 << 7;

/// Upper two bits of FIFO_CONFIG_1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Mode {
    /// Nothing is stored.
    Bypass,
    /// When full, it takes no more samples until it is configured again.
    Fifo,
    /// When full, it drops the oldest sample.
    Stream,
}

#[derive(Clone, Debug)]
pub(super) struct Fifo {
    config: u8,
    frames: VecDeque<[i16; 3]>,
    overrun: bool,
    /// Number of bytes of the oldest frame that have been read.
    read: usize,
    /// Each frame reads one axis too early: it begins with Z of the frame before.
    slipped: bool,
    last_z: i16,
}

impl Fifo {
    pub(super) fn new() -> Self {
        Self {
            config: 0,
            frames: VecDeque::new(),
            overrun: false,
            read: 0,
            slipped: false,
            last_z: 0,
        }
    }

    pub(super) fn config(&self) -> u8 {
        self.config
    }

    /// A write to FIFO_CONFIG_1 also empties the buffer and ends the overrun. Only bypass mode ends a slip (assumed:
    /// PX4 goes through it).
    pub(super) fn configure(&mut self, config: u8) {
        let slipped = self.slipped;
        *self = Self::new();
        self.config = config;
        self.slipped = slipped && self.mode() != Mode::Bypass;
    }

    pub(super) fn slip(&mut self) {
        self.slipped = self.mode() != Mode::Bypass;
    }

    pub(super) fn streams(&self) -> bool {
        self.mode() == Mode::Stream
    }

    /// A write to FIFO_CONFIG_0 empties the buffer.
    pub(super) fn clear(&mut self) {
        self.frames.clear();
        self.read = 0;
    }

    fn mode(&self) -> Mode {
        match self.config >> 6 {
            0 => Mode::Bypass,
            1 => Mode::Fifo,
            _ => Mode::Stream,
        }
    }

    pub(super) fn push(&mut self, frame: [i16; 3]) {
        let full = self.frames.len() == FRAMES;
        match self.mode() {
            Mode::Bypass => return,
            Mode::Fifo if full || self.overrun => {
                self.overrun = true;
                return;
            }
            Mode::Stream if full => {
                self.overrun = true;
                self.frames.pop_front();
                self.read = 0;
            }
            Mode::Fifo | Mode::Stream => {}
        }
        self.frames.push_back(frame);
    }

    pub(super) fn replace_newest(&mut self, frame: [i16; 3]) {
        if let Some(newest) = self.frames.back_mut() {
            *newest = frame;
        }
    }

    /// FIFO_STATUS: frames in the buffer, and whether any were lost.
    pub(super) fn status(&self) -> u8 {
        self.frames.len() as u8 | if self.overrun { OVERRUN } else { 0 }
    }

    /// The next byte of FIFO_DATA; 0 from an empty buffer.
    pub(super) fn read(&mut self) -> u8 {
        let Some(&[x, y, z]) = self.frames.front() else {
            return 0;
        };
        let frame = if self.slipped {
            [self.last_z, x, y]
        } else {
            [x, y, z]
        };
        let byte = frame[self.read / 2].to_le_bytes()[self.read % 2];
        self.read += 1;
        if self.read == FRAME_LEN {
            self.frames.pop_front();
            self.last_z = z;
            self.read = 0;
        }
        byte
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn filled(config: u8, frames: i16) -> Fifo {
        let mut fifo = Fifo::new();
        fifo.configure(config);
        for x in 0..frames {
            fifo.push([x, 0, -1]);
        }
        fifo
    }

    #[test]
    fn frames_come_out_oldest_first_low_bytes_first() {
        let mut fifo = filled(0x80, 2);
        assert_eq!(fifo.status(), 2);
        let bytes: [u8; 14] = std::array::from_fn(|_| fifo.read());
        assert_eq!(
            bytes,
            [0, 0, 0, 0, 0xFF, 0xFF, 1, 0, 0, 0, 0xFF, 0xFF, 0, 0]
        );
        assert_eq!(fifo.status(), 0);
    }

    #[test]
    fn when_full_it_keeps_the_newest_or_the_oldest_and_sets_the_overrun_bit() {
        for (config, first) in [(0x80, 1), (0x40, 0)] {
            let mut fifo = filled(config, 101);
            assert_eq!(fifo.status(), 0x80 | 100);
            assert_eq!(fifo.read(), first);
            fifo.clear();
            assert_eq!(fifo.status(), 0x80);
            fifo.configure(config);
            assert_eq!(fifo.status(), 0);
        }
        assert_eq!(filled(0x00, 5).status(), 0);
    }

    /// Datasheet: in FIFO mode no frame is stored after the overrun until FIFO_CONFIG_1 is written.
    #[test]
    fn in_fifo_mode_it_stores_nothing_after_an_overrun() {
        let mut fifo = filled(0x40, 101);
        for _ in 0..FRAMES * FRAME_LEN {
            fifo.read();
        }
        fifo.push([7; 3]);
        assert_eq!(fifo.status(), 0x80);
        fifo.configure(0x40);
        fifo.push([7; 3]);
        assert_eq!(fifo.status(), 1);
    }

    #[test]
    fn slipped_by_an_axis_it_stays_so_until_it_was_switched_off() {
        let mut fifo = filled(0x80, 0);
        let read = |fifo: &mut Fifo| {
            fifo.push([1, 2, 3]);
            let bytes: [u8; 6] = std::array::from_fn(|_| fifo.read());
            [bytes[0], bytes[2], bytes[4]]
        };
        assert_eq!(read(&mut fifo), [1, 2, 3]);
        fifo.slip();
        assert_eq!(read(&mut fifo), [3, 1, 2]);
        fifo.configure(0x80);
        read(&mut fifo);
        assert_eq!(read(&mut fifo), [3, 1, 2]);
        fifo.configure(0);
        fifo.configure(0x40);
        assert_eq!(read(&mut fifo), [1, 2, 3]);
    }
}
