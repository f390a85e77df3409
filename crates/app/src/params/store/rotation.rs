//! Rotation from a full sector to the next: all records are copied, and then the head makes it the active one.

use embedded_storage::nor_flash::NorFlash;

use super::{Active, ConsecutiveFailures, Cursor, FIRST_SLOT, LAST_SLOT, Store};
use crate::{
    domain::ParamError,
    params::sector::{OPENED_AT, SectorState},
};

#[derive(Debug)]
pub(super) struct Rotation {
    target: u8,
    next_slot: u8,
    cursor: Cursor,
    failures: ConsecutiveFailures,
}

impl<F: NorFlash> Store<F> {
    /// Opens a clean sector. From here on it needs an erase before it is clean again.
    pub(super) fn open_sector(&mut self, target: u8) -> Result<(), ParamError> {
        self.set_state(target, SectorState::Garbage);
        self.program(target, 0, OPENED_AT, &[0; 4])?;
        self.rotation = Some(Rotation {
            target,
            next_slot: FIRST_SLOT,
            cursor: Cursor::new(),
            failures: ConsecutiveFailures(0),
        });
        Ok(())
    }

    /// Copies one record, or after the last one commits the head.
    pub(super) fn copy_next_record(&mut self) -> Result<(), ParamError> {
        let Some(mut rotation) = self.rotation.take() else {
            return Ok(());
        };
        let place = rotation.next_slot;
        // At least one slot must remain for the record to be saved.
        if place > LAST_SLOT {
            self.set_failed(rotation.target, true);
            return Err(ParamError::Full);
        }
        let Some(slot) = self.next_newest(&mut rotation.cursor) else {
            return self.commit(&rotation);
        };
        rotation.next_slot = place.saturating_add(1);
        let written = self.write_slot(rotation.target, place, &slot);
        if written.is_err() {
            rotation.cursor.step_back();
        }
        rotation.failures.count(written);
        if rotation.failures.limit_reached() {
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
            // The remains must not become a valid head later. If clearing fails too, the erase tries again.
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
