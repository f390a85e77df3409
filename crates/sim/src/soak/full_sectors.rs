//! Parameter sectors that are nearly full: it takes few saves to begin another one.

use super::harmless::START;
use crate::{
    machine::flash::PARAMETER_FLASH_BYTES,
    parameter_sectors::{self, Record, SECTOR_BYTES},
};

/// In sector 0, of 127; the first of them hold [`FOREIGN`] records.
const USED: usize = 125;
/// Of groups that this firmware does not have. Each change of sectors takes them along, so the next one is near again.
const FOREIGN: usize = 56;
const FIRST_FOREIGN: u8 = 100;
const GENERATION: u32 = 7;

/// Sector 0 in use, sector 1 clean, sector 2 the one before, which is to be erased next.
pub fn contents() -> [u8; PARAMETER_FLASH_BYTES] {
    let mut bytes = parameter_sectors::clean();
    let records = records();
    let sectors = bytes.chunks_exact_mut(SECTOR_BYTES);
    for (sector, bytes) in sectors.enumerate() {
        match sector {
            0 => parameter_sectors::fill(bytes, GENERATION, records.iter()),
            2 => parameter_sectors::fill(bytes, GENERATION - 1, records.iter()),
            _ => {}
        }
    }
    bytes
}

fn records() -> Vec<Record> {
    let foreign = (0..FOREIGN).map(|n| Record::first(FIRST_FOREIGN + n as u8, &[n as f32]));
    let own = START.iter().cycle().skip(FOREIGN % START.len());
    let own = own.map(|(group, values)| Record::first(*group, values));
    foreign.chain(own).take(USED).collect()
}
