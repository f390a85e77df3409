//! The parameter store: records in three flash sectors that no power cut can lose (docs/parameters.md).
//!
//! Records are appended to the *active* sector, which has the highest generation. When it is full, the newest copy of
//! every record is copied to a clean sector. Writing that sector's head comes last and makes it the active one. The
//! old sector remains as a backup until the next clean sector is needed. A sector is erased only while none is clean.
//! So an erase follows such a rotation, and a save rarely has to wait for one.

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

use reading::Cursor;
use rotation::Rotation;

/// Number of records whose newest copies a rotation keeps.
pub const MAX_RECORDS: usize = 64;

/// Result of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Progress {
    /// The given record is in flash and was read back. No power cut can undo it.
    Stored,
    /// More steps may follow: see [`Store::next`].
    Worked,
}

/// State of the store.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StoreReport {
    /// Generation of the active sector; 0 without one.
    pub generation: u32,
    /// Slots of the active sector that `open` found neither blank nor with a record.
    pub damaged: u16,
    /// Number of records that fit before the next rotation.
    pub free_slots: u16,
    /// Sectors whose head `open` found ruined by something other than a power cut. Their records are lost, and older
    /// values or none take their place.
    pub lost_sectors: u8,
    /// Sectors in which `open` found something other than a store, while there was no store either.
    pub strange_sectors: u8,
}

/// A store in `F`: 48 KiB from offset 0, with sectors of 16 KiB and words of 4 bytes.
///
/// Programming must be able to clear further bits of a word that is not blank, as the STM32F4's flash can. A read
/// after `write` or `erase` must return the cells' contents rather than those of a cache.
///
/// ```
/// use embedded_storage::nor_flash::{ErrorType, NorFlash, NorFlashErrorKind, ReadNorFlash};
/// use robot_app::domain::FlashRequest;
/// use robot_app::params::{Progress, Record, RecordId, Store};
///
/// struct Flash(Vec<u8>);
///
/// impl ErrorType for Flash {
///     type Error = NorFlashErrorKind;
/// }
/// impl ReadNorFlash for Flash {
///     const READ_SIZE: usize = 1;
///     fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), NorFlashErrorKind> {
///         bytes.copy_from_slice(&self.0[offset as usize..][..bytes.len()]);
///         Ok(())
///     }
///     fn capacity(&self) -> usize {
///         self.0.len()
///     }
/// }
/// impl NorFlash for Flash {
///     const WRITE_SIZE: usize = 4;
///     const ERASE_SIZE: usize = 0x4000;
///     fn erase(&mut self, from: u32, to: u32) -> Result<(), NorFlashErrorKind> {
///         self.0[from as usize..to as usize].fill(0xFF);
///         Ok(())
///     }
///     fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), NorFlashErrorKind> {
///         for (cell, byte) in self.0[offset as usize..].iter_mut().zip(bytes) {
///             *cell &= byte;
///         }
///         Ok(())
///     }
/// }
///
/// let mut store = Store::open(Flash(vec![0xFF; 3 * 0x4000]));
/// let record = Record {
///     id: RecordId { key: 7, variant: 0 },
///     version: 1,
///     values: [0x4220_0000].into_iter().collect(),
/// };
/// assert_eq!(store.next(true), FlashRequest::Erase); // a new chip has no clean sector
/// while store.work(Some(&record)) != Ok(Progress::Stored) {}
/// let mut found = Vec::new();
/// store.for_each(|record| found.push(record.clone()));
/// assert_eq!(found, [record]);
/// ```
#[derive(Debug)]
pub struct Store<F> {
    flash: F,
    sectors: [Sector; SECTORS as usize],
    /// State of the sector with the highest generation.
    active: Active,
    rotation: Option<Rotation>,
    damaged: u16,
    lost_sectors: u8,
    strange_sectors: u8,
}

#[derive(Clone, Copy, Debug)]
struct Sector {
    state: SectorState,
    /// An operation on the sector has failed since boot. Such a sector is used last.
    failed: bool,
}

/// What is known of the active sector beyond its state.
#[derive(Clone, Copy, Debug)]
struct Active {
    /// Slot for the next record. Beyond `LAST_SLOT` the sector is full.
    next_slot: u8,
    /// The head has been read back, so no power cut left it half programmed.
    head_is_proven: bool,
    /// The same for the last occupied slot.
    slot_is_proven: bool,
    /// Verifying the head failed, so the next boot may not find it.
    head_is_unreliable: bool,
    failures: ConsecutiveFailures,
}

/// Counts consecutive slots that failed to take a record.
#[derive(Clone, Copy, Debug, Default)]
struct ConsecutiveFailures(u8);

impl ConsecutiveFailures {
    /// After this number the sector counts as worn out.
    const MAX: u8 = 3;

    /// Counts a result. An error of the flash controller says nothing about the sector.
    fn count(&mut self, written: Result<(), ParamError>) {
        match written {
            Ok(()) => self.0 = 0,
            Err(ParamError::NotProgrammed) => self.0 = self.0.saturating_add(1),
            Err(_) => {}
        }
    }

    fn limit_reached(self) -> bool {
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
    /// Reads the state of all sectors. It never fails and never writes.
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

    /// Calls `f` with the newest intact copy of every record, in no particular order.
    ///
    /// At boot, first program what [`Store::next`] requests. A record that a power cut left half programmed then
    /// stays as it is read here.
    pub fn for_each(&mut self, mut f: impl FnMut(&Record)) {
        let mut cursor = Cursor::new();
        while let Some(slot) = self.next_newest(&mut cursor) {
            f(&slot.record());
        }
    }

    /// State of the store.
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

    /// The operation that [`Store::work`] would perform now, with a record or without.
    pub fn next(&self, want_write: bool) -> FlashRequest {
        match self.plan(want_write) {
            None => FlashRequest::None,
            Some(Step::Erase { .. }) => FlashRequest::Erase,
            Some(_) => FlashRequest::Program,
        }
    }

    /// Performs one step: programs at most one slot or head, or erases one sector.
    ///
    /// # Errors Returns why the step failed. The next call tries an alternative if there is one. No stored record is
    /// lost.
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
            (Some(Step::Move), _) => self.copy_next_record(),
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
            // A head that cannot be read now must not return later and hide what is written from here on.
            if let Some(sector) = self.first_in(SectorState::Garbage) {
                return Some(Step::ClearHead { sector });
            }
            if let Some((sector, _)) = active
                && self.active.next_slot <= LAST_SLOT
                && !(self.active.failures.limit_reached() && self.has_another_sector())
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
    /// A sector without room and with nothing to verify.
    const FULL: Self = Self {
        next_slot: LAST_SLOT.saturating_add(1),
        head_is_proven: true,
        slot_is_proven: true,
        head_is_unreliable: false,
        failures: ConsecutiveFailures(0),
    };
}

#[cfg(test)]
mod tests;
