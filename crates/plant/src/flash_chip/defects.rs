//! Worn-out cells and sectors.

use super::sectors::PerSector;

/// A cell that always reads the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StuckBit {
    /// Address of its byte.
    pub address: u32,
    /// Number of the bit, 0 … 7.
    pub bit: u8,
    /// The value that it reads.
    pub value: bool,
}

/// How the erase of a worn-out sector fails. The chip reports neither failure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EraseFault {
    /// All words keep their contents.
    DoesNothing,
    /// About one word in 64 keeps its contents.
    LeavesSomeWords,
}

#[derive(Clone, Debug, Default)]
pub(super) struct Defects {
    stuck: Vec<StuckBit>,
    erase: PerSector<Option<EraseFault>>,
}

impl Defects {
    pub fn stick(&mut self, bit: StuckBit) {
        self.stuck.push(bit);
    }

    pub fn repair_bits(&mut self) {
        self.stuck.clear();
    }

    pub fn set_erase_fault(&mut self, sector: u8, fault: Option<EraseFault>) {
        if let Some(place) = self.erase.get_mut(sector) {
            *place = fault;
        }
    }

    pub fn erase_fault(&self, sector: u8) -> Option<EraseFault> {
        self.erase.get(sector).flatten()
    }

    /// Overwrites the stuck bits in the bytes read at `address`.
    pub fn distort(&self, address: u32, bytes: &mut [u8]) {
        for stuck in &self.stuck {
            let offset = stuck.address.checked_sub(address);
            let Some(byte) = offset.and_then(|offset| bytes.get_mut(offset as usize)) else {
                continue;
            };
            let mask = 1 << (stuck.bit & 7);
            *byte = if stuck.value {
                *byte | mask
            } else {
                *byte & !mask
            };
        }
    }
}
