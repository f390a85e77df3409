//! Why the flash refused an operation.

use thiserror::Error;

/// Why the flash refused an operation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum FlashError {
    /// The flash has no power, or lost it during the operation.
    #[error("the flash is without power")]
    PowerLost,
    /// The address is not a multiple of four.
    #[error("{0:#010x} is not the address of a word")]
    NotAligned(u32),
    /// The address is not in sectors 1 to 3.
    #[error("{0:#010x} lies outside of the parameters' sectors")]
    OutOfRange(u32),
    /// The sector is not one of 1 to 3.
    #[error("sector {0} is none of the parameters'")]
    OtherSector(u8),
}
