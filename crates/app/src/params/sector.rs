//! The layout of a flash sector: a head and 127 slots (docs/parameters.md).
//!
//! | word of the head | holds | programmed |
//! |---|---|---|
//! | 0 | `CLEAN`: an erase came back and every word read blank | after the erase |
//! | 1 | opened: anything but blank means that slots may have been written | before the first slot |
//! | 2–5, 6–9 | twice the same: magic and format, generation, its complement, CRC-32 of these three | after the last copied slot |
//! | 10 | proof: anything but blank means that the head was read back | last |

use super::slot::{SLOT_BYTES, is_blank};
use crate::math::checksum::checksum;

pub(super) const SECTORS: u8 = 3;
pub(super) const SECTOR_BYTES: u32 = 16 * 1024;
/// The head occupies slot 0.
pub(super) const FIRST_SLOT: u8 = 1;
pub(super) const LAST_SLOT: u8 = 127;

/// Marks a clean sector. Half of its bits are ones, so neither an erased word nor one programmed to zero resembles
/// it.
pub(super) const CLEAN: [u8; 4] = *b"\xC1\xEA\x5E\xD0";
/// The digit is the number of the format.
const MAGIC: [u8; 4] = *b"PRM1";

/// Offsets in the head, in bytes.
pub(super) const OPENED_AT: usize = 4;
pub(super) const COPIES_AT: [usize; 2] = [8, 24];
pub(super) const HEAD_PROOF_AT: usize = 40;
pub(super) const HEAD_BYTES: usize = 44;

/// Size of one of the two copies.
const COPY_BYTES: usize = 16;

/// State of a sector.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum SectorState {
    /// Blank after a completed erase.
    Clean,
    /// The sector holds all records that existed when it was begun, and those saved since.
    Headed { generation: u32 },
    /// The sector must be erased before use. Its contents are no head now, but might be one at the next boot.
    Garbage,
    /// As `Garbage`, but the head is blank or cleared, so it cannot return.
    Headless,
}

/// Encodes one of the two copies that commit a head.
#[inline(never)]
pub(super) fn commitment(generation: u32) -> [u8; COPY_BYTES] {
    let mut copy = [0; COPY_BYTES];
    copy[..4].copy_from_slice(&MAGIC);
    copy[4..8].copy_from_slice(&generation.to_le_bytes());
    copy[8..12].copy_from_slice(&(!generation).to_le_bytes());
    let crc = checksum(&copy[..12]);
    copy[12..].copy_from_slice(&crc.to_le_bytes());
    copy
}

/// The first 128 bytes of a sector, read once.
pub(super) struct Head {
    pub bytes: [u8; SLOT_BYTES],
}

impl Head {
    /// Generation in the first correct copy.
    pub fn generation(&self) -> Option<u32> {
        COPIES_AT.into_iter().find_map(|at| {
            let copy = self.bytes.get(at..)?.first_chunk::<COPY_BYTES>()?;
            let [_, _, _, _, a, b, c, d, ..] = *copy;
            let generation = u32::from_le_bytes([a, b, c, d]);
            (*copy == commitment(generation)).then_some(generation)
        })
    }

    /// Whether both copies hold something wrong. An interrupted rotation leaves the second copy blank, and an erase
    /// clears both first, so a power cut does not cause this.
    pub fn is_ruined(&self) -> bool {
        COPIES_AT.into_iter().all(|at| {
            let copy = self.bytes.get(at..).and_then(|rest| rest.get(..COPY_BYTES));
            copy.is_some_and(has_data)
        })
    }

    /// Whether one of the store's own marks is there, with some bits possibly wrong. It shows that the sector held a
    /// head of the store rather than a program. One in 700 programs passes for a head.
    pub fn has_marks(&self) -> bool {
        let [first, second] = COPIES_AT;
        [(0, CLEAN), (first, MAGIC), (second, MAGIC)]
            .into_iter()
            .any(|(at, mark)| {
                let found = self.bytes.get(at..).and_then(|rest| rest.first_chunk());
                found.is_some_and(|found| matches_mark(*found, mark))
            })
    }

    pub fn is_blank(&self) -> bool {
        is_blank(&self.bytes)
    }

    pub fn is_proven(&self) -> bool {
        let proof = &self.bytes[HEAD_PROOF_AT..HEAD_BYTES];
        !is_blank(proof)
    }

    /// Whether the head holds the clean mark and nothing else.
    pub fn is_clean(&self) -> bool {
        let (mark, rest) = self.bytes.split_at(OPENED_AT);
        mark == CLEAN && is_blank(rest)
    }
}

/// Whether a word is neither blank nor cleared, with one or two stuck bits tolerated.
#[inline(never)]
fn has_data(bytes: &[u8]) -> bool {
    const STUCK: u32 = 2;
    let (words, _) = bytes.as_chunks();
    let mut ones = words
        .iter()
        .map(|word| u32::from_le_bytes(*word).count_ones());
    ones.any(|ones| ones > STUCK && ones < 32 - STUCK)
}

fn matches_mark(found: [u8; 4], mark: [u8; 4]) -> bool {
    const WRONG_BITS: u32 = 6;
    let wrong = u32::from_le_bytes(found) ^ u32::from_le_bytes(mark);
    wrong.count_ones() <= WRONG_BITS
}

/// Offset from the start of the store of a slot, or of the head with slot 0.
pub(super) fn offset(sector: u8, slot: u8) -> u32 {
    let sector = u32::from(sector).wrapping_mul(SECTOR_BYTES);
    sector.wrapping_add(u32::from(slot).wrapping_mul(SLOT_BYTES as u32))
}

#[cfg(test)]
mod tests;
