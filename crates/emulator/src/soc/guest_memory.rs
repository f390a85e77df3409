//! The memories as DMA accesses them: SRAM, CCM and flash.

/// The memories, which the CPU owns and DMA borrows.
pub trait GuestMemory {
    /// Returns false if no memory answers.
    fn read(&mut self, addr: u32, out: &mut [u8]) -> bool;
    /// Returns false if no memory answers.
    fn write(&mut self, addr: u32, data: &[u8]) -> bool;
}
