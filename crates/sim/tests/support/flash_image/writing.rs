//! Dumps made by hand: full, damaged, foreign.

use super::{
    CLEAN, COPIES_AT, COPY_BYTES, CRC_AT, HEAD_PROOF_AT, HEADER_AT, Id, MAGIC, OPENED_AT, PROOF_AT,
    SECTOR_BYTES, SLOT_BYTES, STORE_BYTES, Stored, VALUES_AT, crc32,
};

/// Three parameter sectors. Starts blank, as a new chip is.
#[derive(Clone)]
pub struct Image {
    bytes: Box<[u8; STORE_BYTES]>,
}

impl Image {
    pub fn blank() -> Self {
        Self {
            bytes: Box::new([0xFF; STORE_BYTES]),
        }
    }

    /// An image with the contents of a dump.
    pub fn of(dump: &[u8]) -> Self {
        let mut image = Self::blank();
        image.bytes.copy_from_slice(dump);
        image
    }

    pub fn bytes(&self) -> &[u8; STORE_BYTES] {
        &self.bytes
    }

    /// Makes the sector blank, without the mark of a completed erase.
    pub fn erased(self, sector: usize) -> Self {
        self.garbage(sector, || 0xFF)
    }

    /// Marks the sector as erased.
    pub fn clean(mut self, sector: usize) -> Self {
        self.put(sector, 0, 0, &CLEAN);
        self
    }

    /// The sector is one in use, read back after it was begun.
    pub fn headed(self, sector: usize, generation: u32) -> Self {
        let mut headed = self.clean(sector);
        headed.put(sector, 0, OPENED_AT, &[0; 4]);
        let mut copy = Vec::with_capacity(COPY_BYTES);
        copy.extend(MAGIC);
        copy.extend(generation.to_le_bytes());
        copy.extend((!generation).to_le_bytes());
        copy.extend(crc32(&copy).to_le_bytes());
        for at in COPIES_AT {
            headed.put(sector, 0, at, &copy);
        }
        headed.put(sector, 0, HEAD_PROOF_AT, &[0; 4]);
        headed
    }

    /// A record in slot 1 … 127 of the sector.
    pub fn record(mut self, sector: usize, slot: usize, id: Id, stored: &Stored) -> Self {
        let mut bytes = [0xFF; SLOT_BYTES];
        bytes[..HEADER_AT].fill(0);
        let count = stored.values.len() as u8;
        bytes[HEADER_AT..VALUES_AT].copy_from_slice(&[id.0, stored.version, count, id.1]);
        let places = bytes[VALUES_AT..PROOF_AT].chunks_exact_mut(4);
        for (place, value) in places.zip(&stored.values) {
            place.copy_from_slice(&value.to_le_bytes());
        }
        let crc = crc32(&bytes[HEADER_AT..PROOF_AT]);
        bytes[PROOF_AT..CRC_AT].fill(0);
        bytes[CRC_AT..].copy_from_slice(&crc.to_le_bytes());
        self.put(sector, slot, 0, &bytes);
        self
    }

    /// Every byte of the sector as `byte` gives it.
    pub fn garbage(mut self, sector: usize, mut byte: impl FnMut() -> u8) -> Self {
        let start = sector * SECTOR_BYTES;
        self.bytes[start..start + SECTOR_BYTES].fill_with(&mut byte);
        self
    }

    /// The same for its head alone.
    pub fn garbage_head(mut self, sector: usize, mut byte: impl FnMut() -> u8) -> Self {
        let start = sector * SECTOR_BYTES;
        self.bytes[start..start + SLOT_BYTES].fill_with(&mut byte);
        self
    }

    /// Turns one bit over; `place` counts bytes from the start of the store.
    pub fn flipped(mut self, place: usize, bit: u8) -> Self {
        self.bytes[place] ^= 1 << bit;
        self
    }

    fn put(&mut self, sector: usize, slot: usize, at: usize, bytes: &[u8]) {
        let start = sector * SECTOR_BYTES + slot * SLOT_BYTES + at;
        self.bytes[start..start + bytes.len()].copy_from_slice(bytes);
    }
}
