//! Which sector is erased, and when it counts as clean.

use embedded_storage::nor_flash::NorFlash;

use super::{SECTORS, Store};
use crate::params::{
    ParamError,
    sector::{CLEAN, HEAD_BYTES, SECTOR_BYTES, SectorState, offset},
};

impl<F: NorFlash> Store<F> {
    /// Never the active sector. Garbage before the oldest backup; what failed before, after everything else.
    pub(super) fn victim(&self) -> Option<u8> {
        let active = self.newest(0).map(|(sector, _)| sector);
        let numbered = self.sectors.iter().zip(0..SECTORS);
        let candidates = numbered.filter(|(_, number)| Some(*number) != active);
        let victim = candidates.min_by_key(|(sector, _)| {
            let age = match sector.state {
                SectorState::Headed { generation } => generation,
                SectorState::Clean | SectorState::Garbage => 0,
            };
            (sector.failed, age)
        });
        victim.map(|(_, number)| number)
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
        // If the erase is cut short, neither an old head nor an old mark may be left.
        self.program(sector, 0, 0, &[0; HEAD_BYTES])?;
        let from = offset(sector, 0);
        let to = from.wrapping_add(SECTOR_BYTES);
        self.flash.erase(from, to).map_err(|_| ParamError::Flash)?;
        if !(self.read_slot(sector, 0).is_blank() && self.has_blank_slots(sector)) {
            return Err(ParamError::NotErased);
        }
        self.program(sector, 0, 0, &CLEAN)?;
        if !self.read_head(sector).is_clean() {
            return Err(ParamError::NotProgrammed);
        }
        Ok(())
    }

    pub(super) fn set_failed(&mut self, sector: u8, failed: bool) {
        if let Some(sector) = self.sectors.get_mut(usize::from(sector)) {
            sector.failed = failed;
        }
    }
}
