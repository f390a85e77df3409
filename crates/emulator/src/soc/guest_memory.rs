//! SRAM, CCM and flash as DMA sees them.

/// The CPU owns the memories; DMA borrows them.
pub trait GuestMemory {
    /// False where no memory answers.
    fn read(&mut self, addr: u32, out: &mut [u8]) -> bool;
    /// False where no memory answers.
    fn write(&mut self, addr: u32, data: &[u8]) -> bool;
}
