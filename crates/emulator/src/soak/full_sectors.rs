//! Parameter sectors as docs/parameters.md lays them out, nearly full: it takes few saves to begin another one.

use super::harmless::START;
use crate::machine::flash::PARAMETER_FLASH_BYTES;

const SLOT: usize = 128;
/// In sector 0, of 127; the first of them hold [`FOREIGN`] records.
const USED: usize = 125;
/// Of groups that this firmware does not have. Each change of sectors takes them along, so the next one is near again.
const FOREIGN: usize = 56;
const FIRST_FOREIGN: u8 = 100;

const CLEAN: u32 = 0xD05E_EAC1;
const MAGIC: u32 = u32::from_le_bytes(*b"PRM1");
const GENERATION: u32 = 7;

/// Sector 0 in use, sector 1 clean, sector 2 the one before, which is to be erased next.
pub fn contents() -> [u8; PARAMETER_FLASH_BYTES] {
    let mut bytes = [0xFF; PARAMETER_FLASH_BYTES];
    for (sector, bytes) in bytes
        .chunks_exact_mut(PARAMETER_FLASH_BYTES / 3)
        .enumerate()
    {
        put(bytes, 0, CLEAN);
        match sector {
            0 => fill(bytes, GENERATION),
            2 => fill(bytes, GENERATION - 1),
            _ => {}
        }
    }
    bytes
}

fn fill(sector: &mut [u8], generation: u32) {
    let check = [MAGIC, generation, !generation];
    let crc = crc32(check.iter().flat_map(|word| word.to_le_bytes()));
    put(sector, 1, 0);
    for copy in [2, 6] {
        for (n, word) in check.into_iter().chain([crc]).enumerate() {
            put(sector, copy + n, word);
        }
    }
    put(sector, 10, 0);
    let slots = sector.chunks_exact_mut(SLOT).skip(1).take(USED);
    for (n, slot) in slots.enumerate() {
        let groups = START.len();
        if n < FOREIGN {
            record(slot, FIRST_FOREIGN + n as u8, &[n as f32]);
        } else if let Some((group, values)) = START.get(n % groups) {
            record(slot, *group, values);
        }
    }
}

fn record(slot: &mut [u8], key: u8, values: &[f32]) {
    put(slot, 0, 0);
    put(slot, 1, u32::from_le_bytes([key, 1, values.len() as u8, 0]));
    for (n, value) in values.iter().enumerate() {
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

/// As in zip.
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
        record(&mut slot, 7, &[45.0, 0.5, 0.25, 0.75]);
        assert_eq!(slot[..12], [0, 0, 0, 0, 7, 1, 4, 0, 0, 0, 0x34, 0x42]);
        assert_eq!(slot[120..], [0, 0, 0, 0, 0xF5, 0x98, 0x4F, 0x98]);
    }
}
