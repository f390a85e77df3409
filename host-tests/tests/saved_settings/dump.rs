//! Flash contents by hand, from the tables of docs/parameters.md.

use flate2::Crc;

use crate::robot::Chip;

const SECTOR_1: u32 = 0x0800_4000;
const SLOT: usize = 128;

fn crc(bytes: &[u8]) -> [u8; 4] {
    let mut crc = Crc::new();
    crc.update(bytes);
    crc.sum().to_le_bytes()
}

/// 128 bytes: guard, header, values, blank, proof, CRC.
pub fn slot([key, version, variant]: [u8; 3], values: &[f32]) -> Vec<u8> {
    let mut bytes = vec![0, 0, 0, 0, key, version, values.len() as u8, variant];
    bytes.extend(values.iter().flat_map(|value| value.to_le_bytes()));
    bytes.resize(120, 0xFF);
    let crc = crc(&bytes[4..]);
    bytes.extend([0; 4]);
    bytes.extend(crc);
    bytes
}

/// 128 bytes: clean mark, opened, two copies of the commitment, proof.
fn head(generation: u32) -> Vec<u8> {
    let mut copy = b"PRM1".to_vec();
    copy.extend(generation.to_le_bytes());
    copy.extend((!generation).to_le_bytes());
    copy.extend(crc(&copy));
    let mut bytes = vec![0xC1, 0xEA, 0x5E, 0xD0, 0, 0, 0, 0];
    bytes.extend_from_slice(&copy);
    bytes.extend_from_slice(&copy);
    bytes.extend([0; 4]);
    bytes.resize(SLOT, 0xFF);
    bytes
}

/// A chip whose sector 1 is the active one and holds these slots.
pub fn chip(generation: u32, slots: &[Vec<u8>]) -> Chip {
    let chip = Chip::blank();
    let mut bytes = head(generation);
    bytes.extend(slots.concat());
    let mut cells = chip.cells.borrow_mut();
    cells.set_contents(SECTOR_1, &bytes).unwrap();
    drop(cells);
    chip
}

/// Slots of all sectors with these contents, apart from guard and proof.
pub fn copies(dump: &[u8], slot: &[u8]) -> usize {
    let same = |found: &&[u8]| found[4..120] == slot[4..120] && found[124..] == slot[124..];
    dump.chunks_exact(SLOT).filter(same).count()
}
