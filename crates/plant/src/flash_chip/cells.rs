//! The bits, and which of them may read differently from one read to the next.

use std::ops::Range;

use crate::random::Random;

/// Bytes in a word, the smallest unit that the flash programs.
pub(super) const WORD: u32 = 4;
/// An incomplete erase leaves one word in this many.
const ONE_WORD_ESCAPES_IN: u32 = 64;
/// Most bits per sector that an erase cut near its end leaves undecided.
const MAX_UNDECIDED_AT_THE_END: u32 = 8;

#[derive(Clone, Debug)]
pub(super) struct Cells {
    bits: Vec<u8>,
    /// Ones mark cells whose charge lies between the levels.
    unstable: Vec<u8>,
}

impl Cells {
    pub fn blank(length: usize) -> Self {
        Self {
            bits: vec![0xFF; length],
            unstable: vec![0; length],
        }
    }

    pub fn set(&mut self, range: Range<usize>, bytes: &[u8]) {
        self.bits[range.clone()].copy_from_slice(bytes);
        self.unstable[range].fill(0);
    }

    pub fn read(&self, range: Range<usize>, bytes: &mut [u8], random: &mut Random) {
        bytes.copy_from_slice(&self.bits[range.clone()]);
        for (byte, &unstable) in bytes.iter_mut().zip(&self.unstable[range]) {
            if unstable != 0 {
                *byte ^= unstable & random.byte();
            }
        }
    }

    pub fn program(&mut self, start: usize, value: u32) {
        let (bits, unstable) = self.word(start);
        self.set_word(start, bits & value, unstable & value);
    }

    /// A program that was cut: some of the bits to be cleared are cleared, some are undecided, the others untouched. The
    /// shares depend on when the power was cut, which is random, so that the extremes occur too.
    pub fn program_torn(&mut self, start: usize, value: u32, random: &mut Random) {
        let (bits, unstable) = self.word(start);
        let wanted = !value & (bits | unstable);
        let cleared = wanted & some_bits(random);
        let undecided = wanted & !cleared & some_bits(random);
        self.set_word(start, bits & !cleared, (unstable | undecided) & !cleared);
    }

    pub fn erase(&mut self, range: Range<usize>) {
        self.bits[range.clone()].fill(0xFF);
        self.unstable[range].fill(0);
    }

    pub fn erase_in_part(&mut self, range: Range<usize>, random: &mut Random) {
        for start in range.step_by(4) {
            if random.below(ONE_WORD_ESCAPES_IN) != 0 {
                self.erase(start..start + 4);
            }
        }
    }

    /// An erase that was cut. An erase first pulls all bits to 0 and then lifts them to 1 together. Cut early, it leaves some
    /// of the old contents; cut later, noise; cut at its end, a sector that looks erased except for a few bits.
    pub fn erase_torn(&mut self, range: Range<usize>, random: &mut Random) {
        match random.below(4) {
            0 => {
                for start in range.step_by(4) {
                    self.program_torn(start, 0, random);
                }
            }
            1 => {
                self.erase(range.clone());
                for _ in 0..random.below(MAX_UNDECIDED_AT_THE_END + 1) {
                    let place = range.start + random.below(range.len() as u32) as usize;
                    self.unstable[place] |= 1 << random.below(8);
                }
            }
            _ => {
                for place in range {
                    self.bits[place] = random.byte();
                    self.unstable[place] = random.byte();
                }
            }
        }
    }

    fn word(&self, start: usize) -> (u32, u32) {
        let word = |cells: &[u8]| {
            u32::from_le_bytes([
                cells[start],
                cells[start + 1],
                cells[start + 2],
                cells[start + 3],
            ])
        };
        (word(&self.bits), word(&self.unstable))
    }

    fn set_word(&mut self, start: usize, bits: u32, unstable: u32) {
        self.bits[start..start + 4].copy_from_slice(&bits.to_le_bytes());
        self.unstable[start..start + 4].copy_from_slice(&unstable.to_le_bytes());
    }
}

/// A random mask of 32 bits in which none, a quarter, half, three quarters or all bits are ones.
fn some_bits(random: &mut Random) -> u32 {
    match random.below(5) {
        0 => 0,
        1 => random.word() & random.word(),
        2 => random.word(),
        3 => random.word() | random.word(),
        _ => u32::MAX,
    }
}
