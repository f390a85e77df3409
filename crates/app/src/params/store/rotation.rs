//! From a full sector to the next: every record moves, then the head makes it the active one.

use embedded_storage::nor_flash::NorFlash;

use super::{Active, FIRST_SLOT, InARow, LAST_SLOT, Store, Walk};
use crate::{
    domain::ParamError,
    params::sector::{OPENED_AT, SectorState},
};

#[derive(Debug)]
pub(super) struct Rotation {
    target: u8,
    next_slot: u8,
    walk: Walk,
    failures: InARow,
}

impl<F: NorFlash> Store<F> {
    /// From here on the sector needs an erase before it counts as clean again.
    pub(super) fn open_sector(&mut self, target: u8) -> Result<(), ParamError> {
        self.set_state(target, SectorState::Garbage);
        self.program(target, 0, OPENED_AT, &[0; 4])?;
        self.rotation = Some(Rotation {
            target,
            next_slot: FIRST_SLOT,
            walk: Walk::new(),
            failures: InARow(0),
        });
        Ok(())
    }

    /// One record, or after the last one the head.
    pub(super) fn move_one(&mut self) -> Result<(), ParamError> {
        let Some(mut rotation) = self.rotation.take() else {
            return Ok(());
        };
        let place = rotation.next_slot;
        // One slot at least must be left for what is to be saved.
        if place > LAST_SLOT {
            self.set_failed(rotation.target, true);
            return Err(ParamError::Full);
        }
        let Some(slot) = self.next_newest(&mut rotation.walk) else {
            return self.commit(&rotation);
        };
        rotation.next_slot = place.saturating_add(1);
        let written = self.write_slot(rotation.target, place, &slot);
        if written.is_err() {
            rotation.walk.step_back();
        }
        rotation.failures.note(written);
        if rotation.failures.is_too_many() {
            self.set_failed(rotation.target, true);
        } else {
            self.rotation = Some(rotation);
        }
        written
    }

    fn commit(&mut self, rotation: &Rotation) -> Result<(), ParamError> {
        let generation = self.active_sector().map_or(0, |(_, generation)| generation);
        let generation = generation.saturating_add(1);
        if let Err(error) = self.write_head(rotation.target, generation) {
            // What is there must not turn out to be a head after all; if clearing fails too, the erase tries again.
            let _ = self.clear_head(rotation.target);
            self.set_failed(rotation.target, true);
            return Err(error);
        }
        self.set_state(rotation.target, SectorState::Headed { generation });
        self.active = Active {
            next_slot: rotation.next_slot,
            ..Active::FULL
        };
        Ok(())
    }
}
