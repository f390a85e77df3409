//! Selects the sector to erase, and erases it.

use embedded_storage::nor_flash::NorFlash;

use super::{SECTORS, Sector, Store};
use crate::{
    domain::ParamError,
    params::sector::{CLEAN, HEAD_BYTES, SECTOR_BYTES, SectorState, offset},
};

impl<F: NorFlash> Store<F> {
    /// Selects the sector to erase. It is never the active sector, nor its backup while the active head may vanish at
    /// the next boot. Garbage comes before the oldest backup, and sectors that failed come last.
    #[inline(never)]
    pub(super) fn victim(&self) -> Option<u8> {
        let active = self.active_sector();
        let backup = active.and_then(|(_, generation)| self.newest_below(generation));
        let spared = [active, backup.filter(|_| self.active.head_is_unreliable)];
        let mut victim = None;
        for (sector, number) in self.sectors.iter().zip(0..SECTORS) {
            let rank = sector.rank();
            let is_spared = spared.iter().flatten().any(|(spared, _)| *spared == number);
            if !is_spared && victim.is_none_or(|(_, lowest)| rank < lowest) {
                victim = Some((number, rank));
            }
        }
        victim.map(|(number, _)| number)
    }

    /// Whether another sector is clean, or might be erased successfully.
    pub(super) fn has_another_sector(&self) -> bool {
        let active = self.active_sector().map(|(sector, _)| sector);
        let mut sectors = self.sectors.iter().zip(0..SECTORS);
        sectors.any(|(sector, number)| {
            Some(number) != active && (!sector.failed || sector.state == SectorState::Clean)
        })
    }

    pub(super) fn erase(&mut self, sector: u8) -> Result<(), ParamError> {
        self.set_state(sector, SectorState::Garbage);
        self.set_failed(sector, true);
        self.erase_and_mark(sector)?;
        self.set_failed(sector, false);
        self.set_state(sector, SectorState::Clean);
        Ok(())
    }

    fn erase_and_mark(&mut self, sector: u8) -> Result<(), ParamError> {
        // If the erase is interrupted, neither an old head nor an old mark may remain.
        self.clear_head(sector)?;
        let from = offset(sector, 0);
        let to = from.wrapping_add(SECTOR_BYTES);
        self.flash.erase(from, to).map_err(|_| ParamError::Flash)?;
        self.set_state(sector, SectorState::Headless);
        if !(self.read_slot(sector, 0).is_blank() && self.has_blank_slots(sector)) {
            return Err(ParamError::NotErased);
        }
        self.program(sector, 0, 0, &CLEAN)?;
        if !self.read_head(sector).is_clean() {
            return Err(ParamError::NotProgrammed);
        }
        Ok(())
    }

    /// Clears a garbage head. If the controller refuses, it is tried again: saving nothing is better than saving a
    /// record that a later boot may not find.
    pub(super) fn clear_garbage(&mut self, sector: u8) -> Result<(), ParamError> {
        self.clear_head(sector)?;
        self.set_state(sector, SectorState::Headless);
        Ok(())
    }

    pub(super) fn clear_head(&mut self, sector: u8) -> Result<(), ParamError> {
        self.program(sector, 0, 0, &[0; HEAD_BYTES])
    }

    pub(super) fn set_failed(&mut self, sector: u8, failed: bool) {
        if let Some(sector) = self.sectors.get_mut(usize::from(sector)) {
            sector.failed = failed;
        }
    }
}

impl Sector {
    /// Order of erasing, lowest first.
    fn rank(&self) -> u64 {
        let age = match self.state {
            SectorState::Headed { generation } => generation,
            SectorState::Clean | SectorState::Garbage | SectorState::Headless => 0,
        };
        u64::from(self.failed) << 32 | u64::from(age)
    }
}
