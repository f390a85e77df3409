//! The cells of the flash sectors that a program may write, as the flash interface reaches them.

/// Contents of sectors 1–3. They outlive a reset and the loss of power, so the board keeps them.
///
/// Addresses are the processor's and lie in these sectors; words are aligned.
pub trait FlashCells {
    /// The word at `address` as it reads now; an unstable bit may differ from one read to the next.
    fn read_word(&mut self, address: u32) -> u32;
    /// Programs a word: bits go from 1 to 0 only.
    fn program_word(&mut self, address: u32, word: u32);
    /// Erases sector 1, 2 or 3.
    fn erase(&mut self, sector: u8);
    /// A program that a reset or the loss of power cut short.
    fn tear_word(&mut self, address: u32, word: u32);
    /// An erase that a reset or the loss of power cut short.
    fn tear_sector(&mut self, sector: u8);
    /// Whatever is random in the cells follows from `seed` from now on.
    fn reseed(&mut self, seed: u64);
}
