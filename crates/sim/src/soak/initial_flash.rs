//! Parameter sectors at the start: nearly full, so that few saves begin another sector.

use super::tuning_frames::INITIAL_VALUES;
use crate::{
    machine::flash::PARAMETER_FLASH_BYTES,
    parameter_sectors::{self, Record, SECTOR_BYTES},
};

/// Slots in use in sector 0, of 127. The first of them hold [`FOREIGN`] records.
const USED: usize = 125;
/// Records of groups that this firmware does not have. Each change of sectors copies them, so the next one comes soon.
const FOREIGN: usize = 56;
const FIRST_FOREIGN: u8 = 100;
const GENERATION: u32 = 7;

/// Sector 0 is in use, sector 1 is clean, and sector 2 was used before and is to be erased next.
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
    let own = INITIAL_VALUES
        .iter()
        .cycle()
        .skip(FOREIGN % INITIAL_VALUES.len());
    let own = own.map(|(group, values)| Record::first(*group, values));
    foreign.chain(own).take(USED).collect()
}
