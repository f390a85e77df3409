//! The parameter store: records in three flash sectors that no power cut can lose (docs/parameters.md).
//!
//! Records are appended to the *active* sector, the one of the highest generation. When it is full, the newest copy of
//! every record moves to a clean sector, whose head is written last and makes it the active one. The old sector stays
//! as a backup until the next clean sector is needed. A sector is erased only while none is clean, so an erase comes
//! after such a change, and hardly ever is a save left waiting for one.

use embedded_storage::nor_flash::NorFlash;

use super::{
    Record,
    sector::{FIRST_SLOT, LAST_SLOT, SECTORS, SectorState},
};
use crate::domain::{FlashRequest, ParamError};

mod erasing;
mod programming;
mod reading;
mod rotation;

use reading::Walk;
use rotation::Rotation;

/// The newest copies of this many records move along; what is older is left behind.
pub const MAX_RECORDS: usize = 64;

/// What a step has done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Progress {
    /// The record handed in is in flash and was read back. No power cut takes it back.
    Stored,
    /// More steps may follow: see [`Store::next`].
    Worked,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StoreReport {
    /// Of the active sector; 0 without one.
    pub generation: u32,
    /// Places of the active sector that hold neither a record nor nothing, as found by `open`.
    pub damaged: u16,
    /// Records that fit before the next sector is begun.
    pub free_slots: u16,
    /// Sectors whose head was ruined by something else than a power cut, as found by `open`: what was saved there is
    /// gone, and an older value or none is in its place.
    pub lost_sectors: u8,
    /// Sectors that hold something else than a store, as found by `open` where there was no store either.
    pub strange_sectors: u8,
}

/// Records in `F`: 48 KiB from offset 0, sectors of 16 KiB, words of 4 bytes.
///
/// Programming must be able to clear further bits of a word that is not blank, as the STM32F4's flash can, and a read
/// after `write` or `erase` must show the cells, not a cache.
#[derive(Debug)]
pub struct Store<F> {
    flash: F,
    sectors: [Sector; SECTORS as usize],
    /// The sector of the highest generation is the active one.
    active: Active,
    rotation: Option<Rotation>,
    damaged: u16,
    lost_sectors: u8,
    strange_sectors: u8,
}

#[derive(Clone, Copy, Debug)]
struct Sector {
    state: SectorState,
    /// Since boot; such a sector is tried last.
    failed: bool,
}

/// What is known of the active sector beyond its state.
#[derive(Clone, Copy, Debug)]
struct Active {
    /// Where the next record goes; after `LAST_SLOT` the sector is full.
    next_slot: u8,
    /// Read back: no power cut left it half programmed.
    head_is_proven: bool,
    /// The last slot that is taken, likewise.
    slot_is_proven: bool,
    /// It was to be proven and did not take it: the next boot may not find it.
    head_is_doubtful: bool,
    failures: InARow,
}

/// Slots that took no record, one after the other.
#[derive(Clone, Copy, Debug, Default)]
struct InARow(u8);

impl InARow {
    /// Then the sector is taken for worn out.
    const MAX: u8 = 3;

    /// An error of the controller says nothing about the sector.
    fn note(&mut self, written: Result<(), ParamError>) {
        match written {
            Ok(()) => self.0 = 0,
            Err(ParamError::NotProgrammed) => self.0 = self.0.saturating_add(1),
            Err(_) => {}
        }
    }

    fn is_too_many(self) -> bool {
        self.0 >= Self::MAX
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Step {
    ProveHead { sector: u8, generation: u32 },
    ProveSlot { sector: u8 },
    ClearHead { sector: u8 },
    Append { sector: u8 },
    Open { target: u8 },
    Move,
    Erase { sector: u8 },
}

impl<F: NorFlash> Store<F> {
    /// Reads all there is. Never fails and never writes.
    pub fn open(flash: F) -> Self {
        let mut store = Self {
            flash,
            sectors: [Sector {
                state: SectorState::Garbage,
                failed: false,
            }; SECTORS as usize],
            active: Active::FULL,
            rotation: None,
            damaged: 0,
            lost_sectors: 0,
            strange_sectors: 0,
        };
        store.scan();
        store
    }

    /// The newest intact copy of every record, each once, in no particular order.
    ///
    /// At boot, first let the store do what [`Store::next`] asks to program: a record that a power cut left half
    /// programmed then stays as it is read here.
    pub fn for_each(&mut self, mut f: impl FnMut(&Record)) {
        let mut walk = Walk::new();
        while let Some(slot) = self.next_newest(&mut walk) {
            f(&slot.record());
        }
    }

    pub fn report(&self) -> StoreReport {
        let free = LAST_SLOT
            .saturating_add(1)
            .saturating_sub(self.active.next_slot);
        StoreReport {
            generation: self.active_sector().map_or(0, |(_, generation)| generation),
            damaged: self.damaged,
            free_slots: free.into(),
            lost_sectors: self.lost_sectors,
            strange_sectors: self.strange_sectors,
        }
    }

    /// What [`Store::work`] would do now, with a record or without.
    pub fn next(&self, want_write: bool) -> FlashRequest {
        match self.plan(want_write) {
            None => FlashRequest::None,
            Some(Step::Erase { .. }) => FlashRequest::Erase,
            Some(_) => FlashRequest::Program,
        }
    }

    /// One step: programs at most one slot or head, or erases one sector.
    ///
    /// # Errors
    /// Why the step failed. The next call tries something else where there is something else to try; nothing that was
    /// stored is lost.
    pub fn work(&mut self, record: Option<&Record>) -> Result<Progress, ParamError> {
        let done = match (self.plan(record.is_some()), record) {
            (Some(Step::Append { sector }), Some(record)) => {
                return self.append(sector, record).map(|()| Progress::Stored);
            }
            (Some(Step::ProveHead { sector, generation }), _) => {
                self.prove_active_head(sector, generation)
            }
            (Some(Step::ProveSlot { sector }), _) => self.prove_last_slot(sector),
            (Some(Step::ClearHead { sector }), _) => self.clear_garbage(sector),
            (Some(Step::Open { target }), _) => self.open_sector(target),
            (Some(Step::Move), _) => self.move_one(),
            (Some(Step::Erase { sector }), _) => self.erase(sector),
            (Some(Step::Append { .. }) | None, _) => Ok(()),
        };
        done.map(|()| Progress::Worked)
    }

    fn plan(&self, want_write: bool) -> Option<Step> {
        let active = self.active_sector();
        if let Some((sector, generation)) = active {
            if !self.active.head_is_proven {
                return Some(Step::ProveHead { sector, generation });
            }
            if !self.active.slot_is_proven {
                return Some(Step::ProveSlot { sector });
            }
        }
        if self.rotation.is_some() {
            return Some(Step::Move);
        }
        let clean = self.first_in(SectorState::Clean);
        if want_write {
            // A head that cannot be read now must not come back and hide what is written from here on.
            if let Some(sector) = self.first_in(SectorState::Garbage) {
                return Some(Step::ClearHead { sector });
            }
            if let Some((sector, _)) = active
                && self.active.next_slot <= LAST_SLOT
                && !(self.active.failures.is_too_many() && self.has_another_sector())
            {
                return Some(Step::Append { sector });
            }
            if let Some(target) = clean {
                return Some(Step::Open { target });
            }
        }
        if clean.is_some() {
            return None;
        }
        self.victim().map(|sector| Step::Erase { sector })
    }
}

impl Active {
    /// Nothing to prove and no room.
    const FULL: Self = Self {
        next_slot: LAST_SLOT.saturating_add(1),
        head_is_proven: true,
        slot_is_proven: true,
        head_is_doubtful: false,
        failures: InARow(0),
    };
}

#[cfg(test)]
mod tests;
