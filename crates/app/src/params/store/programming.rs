//! Writes records and heads, and reads them back before they count.

use embedded_storage::nor_flash::NorFlash;

use super::{LAST_SLOT, Store};
use crate::{
    domain::ParamError,
    params::{
        Record,
        sector::{COPIES_AT, HEAD_PROOF_AT, commitment, offset},
        slot::{BODY_AT, CRC_AT, PROOF_AT, SLOT_BYTES, Slot},
    },
};

/// A mark only counts as blank or not.
const MARK: [u8; 4] = [0; 4];

impl<F: NorFlash> Store<F> {
    pub(super) fn append(&mut self, sector: u8, record: &Record) -> Result<(), ParamError> {
        let place = self.active.next_slot;
        // Whatever the result, this slot is not tried again.
        self.active.next_slot = place.saturating_add(1);
        let written = self.write_slot(sector, place, &Slot::from_record(record));
        self.active.failures.count(written);
        self.active.slot_is_proven = written.is_ok();
        written
    }

    /// Writes a slot. The guard comes first, as a half-programmed guard changes nothing. The checksum comes last, and
    /// without it there is no record.
    #[inline(never)]
    pub(super) fn write_slot(
        &mut self,
        sector: u8,
        place: u8,
        slot: &Slot,
    ) -> Result<(), ParamError> {
        self.program(sector, place, 0, &MARK)?;
        self.program(sector, place, BODY_AT, slot.body())?;
        self.program(sector, place, CRC_AT, &slot.bytes[CRC_AT..])?;
        if !self.read_slot(sector, place).holds_the_same(slot) {
            return Err(ParamError::NotProgrammed);
        }
        self.program(sector, place, PROOF_AT, &MARK)
    }

    /// Stabilises the last slot, which a power cut may have left reading differently each time. If it now reads as a
    /// record, it is programmed again and stays one. If not, all its bits are cleared and it never will be one.
    pub(super) fn prove_last_slot(&mut self, sector: u8) -> Result<(), ParamError> {
        // This slot was never confirmed, so a failure here is reported but delays nothing.
        self.active.slot_is_proven = true;
        let place = self.active.next_slot.saturating_sub(1);
        let slot = self.read_slot(sector, place);
        if slot.is_intact() && self.write_slot(sector, place, &slot).is_ok() {
            return Ok(());
        }
        let zeros = [0; SLOT_BYTES];
        self.program(sector, place, BODY_AT, &zeros[BODY_AT..PROOF_AT])?;
        self.program(sector, place, CRC_AT, &zeros[CRC_AT..])?;
        self.program(sector, place, PROOF_AT, &MARK)
    }

    /// Stabilises the head of the active sector: no record may be appended under a head that may vanish at the next
    /// boot.
    pub(super) fn prove_active_head(
        &mut self,
        sector: u8,
        generation: u32,
    ) -> Result<(), ParamError> {
        let proven = self.write_head(sector, generation);
        if proven == Err(ParamError::NotProgrammed) {
            // Every record moves to the next sector.
            self.active.next_slot = LAST_SLOT.saturating_add(1);
            self.active.head_is_unreliable = true;
        }
        if proven != Err(ParamError::Flash) {
            self.active.head_is_proven = true;
        }
        proven
    }

    /// Writes both copies of the head. One that reads back correctly is enough.
    #[inline(never)]
    pub(super) fn write_head(&mut self, sector: u8, generation: u32) -> Result<(), ParamError> {
        for at in COPIES_AT {
            self.program(sector, 0, at, &commitment(generation))?;
        }
        if self.read_head(sector).generation() != Some(generation) {
            return Err(ParamError::NotProgrammed);
        }
        self.program(sector, 0, HEAD_PROOF_AT, &MARK)
    }

    /// `at` and the length are multiples of a word.
    #[inline(never)]
    pub(super) fn program(
        &mut self,
        sector: u8,
        place: u8,
        at: usize,
        bytes: &[u8],
    ) -> Result<(), ParamError> {
        let offset = offset(sector, place).wrapping_add(at as u32);
        self.flash
            .write(offset, bytes)
            .map_err(|_| ParamError::Flash)
    }
}
