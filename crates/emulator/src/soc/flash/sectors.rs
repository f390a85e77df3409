//! Addresses of the sectors that a program may write (RM0090 table 5, 1 MiB in one bank).

use std::ops::{Range, RangeInclusive};

pub const WRITABLE_SECTORS: RangeInclusive<u8> = 1..=3;
const BASE: u32 = 0x0800_0000;
/// Size of each of the first four sectors.
const BYTES: u32 = 0x4000;

/// Addresses of one of [`WRITABLE_SECTORS`].
pub fn addresses(sector: u8) -> Range<u32> {
    let start = BASE + u32::from(sector) * BYTES;
    start..start + BYTES
}
