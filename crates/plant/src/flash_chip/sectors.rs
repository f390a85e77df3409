//! Where the sectors lie (RM0090 table 5, 1 MiB in one bank).

use std::ops::{Range, RangeInclusive};

pub const BASE: u32 = 0x0800_0000;
pub const SECTOR_COUNT: u8 = 12;
/// Kept free of code for the parameters: 0x0800_4000 … 0x0800_FFFF.
pub const PARAMETER_SECTORS: RangeInclusive<u8> = 1..=3;

const KIB: u32 = 1024;

/// Addresses of sector 0 … 11.
pub fn sector_range(sector: u8) -> Option<Range<u32>> {
    (sector < SECTOR_COUNT).then(|| start_address(sector)..start_address(sector + 1))
}

/// Four sectors of 16 KiB, one of 64 KiB, the others of 128 KiB.
pub(super) fn start_address(sector: u8) -> u32 {
    let sector = u32::from(sector);
    BASE + match sector {
        0..=4 => sector * 16 * KIB,
        _ => (sector - 4) * 128 * KIB,
    }
}
