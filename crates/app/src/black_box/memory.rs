//! The memory of the black box: words that one task writes and any other may read.

use core::sync::atomic::{AtomicU32, Ordering};

/// Version of the layout of a bank. Any change of the layout changes it. Layout 1 has records of 16 words, without what
/// the balance controller did.
pub const LAYOUT_VERSION: u8 = 2;
/// The layouts that [`Bank`](super::Bank) reads. All have banks of the same size.
pub const LAYOUTS: [u8; 2] = [1, LAYOUT_VERSION];
/// Number of banks.
pub const BANK_COUNT: usize = 2;
/// Words of a bank.
pub(super) const BANK_WORDS: usize = 3_584;
/// Bytes of a bank.
pub const BANK_BYTES: usize = BANK_WORDS * 4;

/// The two banks. A reader sees every word whole; checksums show which words belong together.
#[derive(Debug)]
pub struct BlackBoxMemory([[AtomicU32; BANK_WORDS]; BANK_COUNT]);

impl Default for BlackBoxMemory {
    fn default() -> Self {
        Self::new()
    }
}

impl BlackBoxMemory {
    /// Memory full of zeros, which holds no event.
    pub const fn new() -> Self {
        Self([const { [const { AtomicU32::new(0) }; BANK_WORDS] }; BANK_COUNT])
    }

    /// The words of a bank from `first` on; fewer than `count` at its end.
    pub(super) fn words(&self, bank: usize, first: usize, count: usize) -> &[AtomicU32] {
        let bank = self.0.get(bank).map_or(&[][..], |bank| bank);
        let rest = bank.get(first..).unwrap_or_default();
        rest.get(..count).unwrap_or(rest)
    }

    /// A word of a bank, 0 beyond its end.
    pub(super) fn word(&self, bank: usize, at: usize) -> u32 {
        let word = self.words(bank, at, 1).first();
        word.map_or(0, |word| word.load(Ordering::Relaxed))
    }

    /// Writes words. Beyond the end of a bank it does nothing.
    #[inline(never)]
    pub(super) fn write(&self, bank: usize, first: usize, values: &[u32]) {
        for (word, value) in self.words(bank, first, values.len()).iter().zip(values) {
            word.store(*value, Ordering::Relaxed);
        }
    }

    /// Fills a bank with zeros.
    pub(super) fn erase(&self, bank: usize) {
        for word in self.words(bank, 0, BANK_WORDS) {
            word.store(0, Ordering::Relaxed);
        }
    }

    /// Reads words; they are 0 beyond the end of a bank.
    #[inline(never)]
    pub(super) fn read(&self, bank: usize, first: usize, values: &mut [u32]) {
        values.fill(0);
        let words = self.words(bank, first, values.len());
        for (value, word) in values.iter_mut().zip(words) {
            *value = word.load(Ordering::Relaxed);
        }
    }

    /// A byte of a bank, as a PC gets it: words are little-endian, and beyond the end there are zeros.
    pub fn byte(&self, bank: usize, at: usize) -> u8 {
        let [a, b, c, d] = self.word(bank, at / 4).to_le_bytes();
        match at % 4 {
            0 => a,
            1 => b,
            2 => c,
            _ => d,
        }
    }

    /// Fills a bank with bytes that another black box gave.
    pub fn fill(&self, bank: usize, bytes: &[u8]) {
        for (at, word) in bytes.as_chunks::<4>().0.iter().enumerate() {
            self.write(bank, at, &[u32::from_le_bytes(*word)]);
        }
    }
}
