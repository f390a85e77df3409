//! A slot: 32 words that hold a record, nothing, or the remains of a power cut (docs/parameters.md).
//!
//! | word | holds | programmed |
//! |---|---|---|
//! | 0 | guard: anything but blank means the slot is taken; its value is never looked at | first |
//! | 1 | key, version, count of values, variant: a byte each | then |
//! | 2… | the values, blank after the last | then |
//! | 30 | proof: anything but blank means that the slot was read back | last |
//! | 31 | CRC-32 (ISO-HDLC) of words 1 to 29 | before the proof |
//!
//! Words are little-endian. Blank is all ones.

use heapless::Vec;

use crate::math::checksum::checksum;

/// Largest number of values in a record.
pub const MAX_VALUES: usize = 28;

pub(super) const SLOT_BYTES: usize = 128;
pub(super) const BLANK: u8 = 0xFF;
/// Offsets in a slot, in bytes.
pub(super) const BODY_AT: usize = 4;
pub(super) const PROOF_AT: usize = 120;
pub(super) const CRC_AT: usize = 124;
const VALUES_AT: usize = 8;

/// Identity of a record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RecordId {
    /// The group: `ParameterGroup::number`.
    pub key: u8,
    /// Separates records of one key that must not be confused, such as those for motors of different makes.
    pub variant: u8,
}

/// The values stored under one identity.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Record {
    /// Identity of the record.
    pub id: RecordId,
    /// Version of the meaning of the values.
    pub version: u8,
    /// The values' bits. The store does not interpret them.
    pub values: Vec<u32, MAX_VALUES>,
}

/// A slot as it was read once. Words torn by a power cut may read differently the next time, so each check uses this
/// copy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Slot {
    pub bytes: [u8; SLOT_BYTES],
}

impl Slot {
    /// Encodes a record. Guard and proof stay blank, as they are programmed separately.
    pub fn from_record(record: &Record) -> Self {
        let mut bytes = [BLANK; SLOT_BYTES];
        let count = record.values.len() as u8;
        let header = [record.id.key, record.version, count, record.id.variant];
        bytes[BODY_AT..VALUES_AT].copy_from_slice(&header);
        let places = bytes[VALUES_AT..PROOF_AT].chunks_exact_mut(4);
        for (place, value) in places.zip(&record.values) {
            place.copy_from_slice(&value.to_le_bytes());
        }
        let crc = checksum(&bytes[BODY_AT..PROOF_AT]);
        bytes[CRC_AT..].copy_from_slice(&crc.to_le_bytes());
        Self { bytes }
    }

    pub fn is_blank(&self) -> bool {
        is_blank(&self.bytes)
    }

    /// The identity in the header, whether or not the slot is intact.
    pub fn claimed_id(&self) -> RecordId {
        RecordId {
            key: self.bytes[4],
            variant: self.bytes[7],
        }
    }

    /// Whether the checksum is right. It is cheap for a blank slot, which claims more values than possible.
    pub fn is_intact(&self) -> bool {
        self.count() <= MAX_VALUES
            && self.bytes[CRC_AT..] == checksum(&self.bytes[BODY_AT..PROOF_AT]).to_le_bytes()
    }

    /// Whether the slot has been read back once, so that its contents are stable.
    pub fn is_proven(&self) -> bool {
        !is_blank(&self.bytes[PROOF_AT..CRC_AT])
    }

    /// Whether both slots hold the same, apart from guard and proof, which only count as blank or not.
    pub fn holds_the_same(&self, other: &Self) -> bool {
        self.bytes[BODY_AT..PROOF_AT] == other.bytes[BODY_AT..PROOF_AT]
            && self.bytes[CRC_AT..] == other.bytes[CRC_AT..]
    }

    /// The record of an intact slot.
    pub fn record(&self) -> Record {
        let places = self.bytes[VALUES_AT..PROOF_AT].chunks_exact(4);
        let words = places.filter_map(|place| Some(u32::from_le_bytes(place.try_into().ok()?)));
        Record {
            id: self.claimed_id(),
            version: self.bytes[5],
            values: words.take(self.count().min(MAX_VALUES)).collect(),
        }
    }

    /// The words between guard and proof, without the blank ones at the end.
    pub fn body(&self) -> &[u8] {
        let body = &self.bytes[BODY_AT..PROOF_AT];
        let last = body.iter().rposition(|byte| *byte != BLANK);
        let length = last.map_or(0, |last| (last | 3).wrapping_add(1));
        body.get(..length).unwrap_or(body)
    }

    fn count(&self) -> usize {
        usize::from(self.bytes[6])
    }
}

/// Out of line, as much of the store: flash is scarce, and this code is not time-critical.
#[inline(never)]
pub(super) fn is_blank(bytes: &[u8]) -> bool {
    bytes.iter().all(|byte| *byte == BLANK)
}

#[cfg(test)]
mod tests;
