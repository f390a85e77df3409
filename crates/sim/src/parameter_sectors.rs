//! Parameter sectors in the layout of docs/parameters.md, written without the firmware's code.

use crate::machine::flash::PARAMETER_FLASH_BYTES;

pub const SECTOR_BYTES: usize = PARAMETER_FLASH_BYTES / 3;
const SLOT: usize = 128;
/// Records that a sector holds; its first slot is the head.
pub const SLOTS: usize = SECTOR_BYTES / SLOT - 1;
/// Words of a slot between its header and its proof.
pub const MAX_VALUES: usize = 28;

const CLEAN: u32 = 0xD05E_EAC1;
const MAGIC: u32 = u32::from_le_bytes(*b"PRM1");

/// A group of settings.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    pub group: u8,
    pub version: u8,
    /// The make of a joint's motor; 0 for other groups.
    pub variant: u8,
    /// At most [`MAX_VALUES`] values, in the order of their indices.
    pub values: Vec<f32>,
}

impl Record {
    /// A record in the first version of its group, which suits every robot.
    pub fn first(group: u8, values: &[f32]) -> Self {
        Self {
            group,
            version: 1,
            variant: 0,
            values: values.to_vec(),
        }
    }
}

/// A sector that is erased and marked as such.
pub fn clean() -> [u8; PARAMETER_FLASH_BYTES] {
    let mut bytes = [0xFF; PARAMETER_FLASH_BYTES];
    for sector in bytes.chunks_exact_mut(SECTOR_BYTES) {
        put(sector, 0, CLEAN);
    }
    bytes
}

/// Sector 0 in use with at most [`SLOTS`] records, the others clean.
pub fn holding(records: &[Record]) -> [u8; PARAMETER_FLASH_BYTES] {
    let mut bytes = clean();
    if let Some(first) = bytes.chunks_exact_mut(SECTOR_BYTES).next() {
        fill(first, 1, records.iter());
    }
    bytes
}

/// Makes a clean sector the active one, with at most [`SLOTS`] records in it.
pub fn fill<'r>(sector: &mut [u8], generation: u32, records: impl Iterator<Item = &'r Record>) {
    let check = [MAGIC, generation, !generation];
    let crc = crc32(check.iter().flat_map(|word| word.to_le_bytes()));
    put(sector, 1, 0);
    for copy in [2, 6] {
        for (n, word) in check.into_iter().chain([crc]).enumerate() {
            put(sector, copy + n, word);
        }
    }
    put(sector, 10, 0);
    let slots = sector.chunks_exact_mut(SLOT).skip(1);
    for (slot, record) in slots.zip(records) {
        write(slot, record);
    }
}

fn write(slot: &mut [u8], record: &Record) {
    let Record {
        group,
        version,
        variant,
        values,
    } = record;
    put(slot, 0, 0);
    let header = [*group, *version, values.len() as u8, *variant];
    put(slot, 1, u32::from_le_bytes(header));
    for (n, value) in values.iter().take(MAX_VALUES).enumerate() {
        put(slot, 2 + n, value.to_bits());
    }
    let crc = crc32(slot.iter().copied().skip(4).take(29 * 4));
    put(slot, 30, 0);
    put(slot, 31, crc);
}

fn put(bytes: &mut [u8], word: usize, value: u32) {
    if let Some(place) = bytes.chunks_exact_mut(4).nth(word) {
        place.copy_from_slice(&value.to_le_bytes());
    }
}

/// CRC-32 as in zip files.
fn crc32(bytes: impl IntoIterator<Item = u8>) -> u32 {
    let crc = bytes.into_iter().fold(u32::MAX, |crc, byte| {
        (0..8).fold(crc ^ u32::from(byte), |crc, _| {
            (crc >> 1) ^ ((crc & 1) * 0xEDB8_8320)
        })
    });
    !crc
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_record_is_the_one_in_the_documentation() {
        let mut slot = [0xFF; SLOT];
        write(&mut slot, &Record::first(7, &[45.0, 0.5, 0.25, 0.75]));
        assert_eq!(slot[..12], [0, 0, 0, 0, 7, 1, 4, 0, 0, 0, 0x34, 0x42]);
        assert_eq!(slot[120..], [0, 0, 0, 0, 0xF5, 0x98, 0x4F, 0x98]);
    }
}
