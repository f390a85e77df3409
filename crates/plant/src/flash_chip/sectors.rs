//! Addresses of the sectors (RM0090 table 5, 1 MiB in one bank).

use std::ops::{Range, RangeInclusive};

/// The sectors that hold parameters instead of code.
pub const PARAMETER_SECTORS: RangeInclusive<u8> = 1..=3;
pub(super) const PARAMETER_ADDRESSES: Range<u32> = 0x0800_4000..0x0801_0000;

const BASE: u32 = 0x0800_0000;
const COUNT: u8 = 12;
const KIB: u32 = 1024;

/// Addresses of one of the sectors 0 to 11, or `None` for another number.
pub fn sector_range(sector: u8) -> Option<Range<u32>> {
    (sector < COUNT).then(|| start_address(sector)..start_address(sector + 1))
}

/// Four sectors of 16 KiB, one of 64 KiB, the others of 128 KiB.
fn start_address(sector: u8) -> u32 {
    let sector = u32::from(sector);
    BASE + match sector {
        0..=4 => sector * 16 * KIB,
        _ => (sector - 4) * 128 * KIB,
    }
}

/// One value per parameter sector.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PerSector<T>([T; 3]);

impl<T: Copy> PerSector<T> {
    pub fn get(&self, sector: u8) -> Option<T> {
        self.0.get(index(sector)?).copied()
    }

    pub fn get_mut(&mut self, sector: u8) -> Option<&mut T> {
        self.0.get_mut(index(sector)?)
    }
}

fn index(sector: u8) -> Option<usize> {
    sector
        .checked_sub(*PARAMETER_SECTORS.start())
        .map(usize::from)
}
