//! The parameter store's flash as `docs/parameters.md` describes it, read and written here without a line of the
//! firmware's code.

mod reading;
mod writing;

use flate2::Crc;

pub use reading::{SectorState, newest, sectors, states};
pub use writing::Image;

/// Sectors 1–3 of the chip; 0 … 2 here.
pub const SECTORS: usize = 3;
pub const SECTOR_BYTES: usize = 16 * 1024;
pub const STORE_BYTES: usize = SECTORS * SECTOR_BYTES;
/// Slot 0 of a sector is its head.
pub const SLOT_BYTES: usize = 128;
pub const LAST_SLOT: usize = 127;

const CLEAN: [u8; 4] = [0xC1, 0xEA, 0x5E, 0xD0];
const MAGIC: [u8; 4] = *b"PRM1";
/// Offsets in the head, in bytes.
const OPENED_AT: usize = 4;
const COPIES_AT: [usize; 2] = [8, 24];
const COPY_BYTES: usize = 16;
const HEAD_PROOF_AT: usize = 40;
/// Offsets in a slot, in bytes.
const HEADER_AT: usize = 4;
const VALUES_AT: usize = 8;
const PROOF_AT: usize = 120;
const CRC_AT: usize = 124;
const MAX_VALUES: usize = 28;

/// Key and variant.
pub type Id = (u8, u8);

/// Contents of a record.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Stored {
    pub version: u8,
    /// Each value is the bits of an `f32`, if the key is one of the current groups.
    pub values: Vec<u32>,
}

impl Stored {
    pub fn of(version: u8, values: &[f32]) -> Self {
        Self {
            version,
            values: values.iter().map(|value| value.to_bits()).collect(),
        }
    }
}

/// CRC-32 as in zip and Ethernet.
fn crc32(bytes: &[u8]) -> u32 {
    let mut crc = Crc::new();
    crc.update(bytes);
    crc.sum()
}

fn word(bytes: &[u8], at: usize) -> u32 {
    u32::from_le_bytes(bytes[at..at + 4].try_into().expect("four bytes"))
}
