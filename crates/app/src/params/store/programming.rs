//! Records and heads into flash, read back before they count.

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

/// A word of a mark: only that it is not blank counts.
const MARK: [u8; 4] = [0; 4];

impl<F: NorFlash> Store<F> {
    pub(super) fn append(&mut self, sector: u8, record: &Record) -> Result<(), ParamError> {
        let place = self.active.next_slot;
        // Whatever happens, the slot is not tried again.
        self.active.next_slot = place.saturating_add(1);
        let written = self.write_slot(sector, place, &Slot::of(record));
        self.active.failures.note(written);
        self.active.slot_is_proven = written.is_ok();
        written
    }

    /// Guard first: a bit it leaves half programmed changes nothing. Checksum last: without it there is no record.
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

    /// A power cut may have left the last slot such that it reads now this way, now that. If it reads as a record now,
    /// it is programmed once more and is one for good; if not, all its bits are cleared and it never will be.
    pub(super) fn prove_last_slot(&mut self, sector: u8) -> Result<(), ParamError> {
        // Nothing in this slot was ever promised, so a failure here is told but keeps nobody waiting.
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

    /// The same for the head: no record is appended under one that may be gone at the next boot.
    pub(super) fn prove_active_head(
        &mut self,
        sector: u8,
        generation: u32,
    ) -> Result<(), ParamError> {
        let proven = self.write_head(sector, generation);
        if proven == Err(ParamError::NotProgrammed) {
            // Everything moves to the next sector.
            self.active.next_slot = LAST_SLOT.saturating_add(1);
            self.active.head_is_doubtful = true;
        }
        if proven != Err(ParamError::Flash) {
            self.active.head_is_proven = true;
        }
        proven
    }

    /// One copy after the other; one that reads back is enough.
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
