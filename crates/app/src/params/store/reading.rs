//! Reads the contents of the sectors.

use embedded_storage::nor_flash::NorFlash;
use heapless::Vec;

use super::{FIRST_SLOT, LAST_SLOT, MAX_RECORDS, SECTORS, Store};
use crate::params::{
    RecordId,
    sector::{Head, SectorState, offset},
    slot::{SLOT_BYTES, Slot},
};

/// A cursor over all slots from the newest to the oldest, across all sectors with a head.
#[derive(Debug)]
pub(super) struct Cursor {
    /// Sectors of this generation and above have been visited.
    below: u32,
    slot: u8,
    /// Records already visited in a newer copy.
    seen: Vec<RecordId, MAX_RECORDS>,
}

impl Cursor {
    pub fn new() -> Self {
        Self {
            below: u32::MAX,
            slot: LAST_SLOT,
            seen: Vec::new(),
        }
    }

    /// Makes the next call return the last record again.
    pub fn step_back(&mut self) {
        self.slot = self.slot.saturating_add(1);
        self.seen.pop();
    }
}

impl<F: NorFlash> Store<F> {
    /// Determines the state of the store at boot.
    #[inline(never)]
    pub(super) fn scan(&mut self) {
        let mut ruined: u8 = 0;
        let mut without_marks: u8 = 0;
        for sector in 0..SECTORS {
            let head = self.read_head(sector);
            let state = self.state_of(sector, &head);
            self.set_state(sector, state);
            if state == SectorState::Garbage && head.is_ruined() {
                ruined = ruined.saturating_add(1);
                if !head.has_marks() && !self.read_slot(sector, FIRST_SLOT).is_intact() {
                    without_marks = without_marks.saturating_add(1);
                }
            }
        }
        // A store in use has cleared the heads of earlier contents.
        if self.active_sector().is_none() {
            self.strange_sectors = without_marks;
            ruined = ruined.saturating_sub(without_marks);
        }
        // One of them may be the remains of an interrupted erase, as a sector is erased only while none is clean.
        let by_a_cut = u8::from(self.first_in(SectorState::Clean).is_none());
        self.lost_sectors = ruined.saturating_sub(by_a_cut);
        if let Some((sector, _)) = self.active_sector() {
            self.scan_active(sector);
        }
    }

    fn scan_active(&mut self, sector: u8) {
        self.active.head_is_proven = self.read_head(sector).is_proven();
        self.active.next_slot = FIRST_SLOT;
        for place in FIRST_SLOT..=LAST_SLOT {
            let slot = self.read_slot(sector, place);
            if slot.is_blank() {
                continue;
            }
            self.active.next_slot = place.saturating_add(1);
            self.active.slot_is_proven = slot.is_proven();
            if !slot.is_intact() {
                self.damaged = self.damaged.saturating_add(1);
            }
        }
    }

    fn state_of(&mut self, sector: u8, head: &Head) -> SectorState {
        if let Some(generation) = head.generation() {
            return SectorState::Headed { generation };
        }
        if head.is_clean() && self.has_blank_slots(sector) {
            return SectorState::Clean;
        }
        if head.is_blank() {
            return SectorState::Headless;
        }
        SectorState::Garbage
    }

    #[inline(never)]
    pub(super) fn has_blank_slots(&mut self, sector: u8) -> bool {
        (FIRST_SLOT..=LAST_SLOT).all(|slot| self.read_slot(sector, slot).is_blank())
    }

    #[inline(never)]
    pub(super) fn first_in(&self, state: SectorState) -> Option<u8> {
        let mut numbered = self.sectors.iter().zip(0..);
        let first = numbered.find(|(sector, _)| sector.state == state);
        first.map(|(_, number)| number)
    }

    pub(super) fn set_state(&mut self, sector: u8, state: SectorState) {
        if let Some(sector) = self.sectors.get_mut(usize::from(sector)) {
            sector.state = state;
        }
    }

    /// The active sector and its generation.
    pub(super) fn active_sector(&self) -> Option<(u8, u32)> {
        self.newest_below(u32::MAX)
    }

    /// Sector and generation of the newest sector below a generation.
    #[inline(never)]
    pub(super) fn newest_below(&self, limit: u32) -> Option<(u8, u32)> {
        let mut found = None;
        for (sector, number) in self.sectors.iter().zip(0..) {
            if let SectorState::Headed { generation } = sector.state
                && generation < limit
                && found.is_none_or(|(_, highest)| generation > highest)
            {
                found = Some((number, generation));
            }
        }
        found
    }

    /// Returns the newest copy of a record that has not been visited.
    #[inline(never)]
    pub(super) fn next_newest(&mut self, cursor: &mut Cursor) -> Option<Slot> {
        while let Some((sector, generation)) = self.newest_below(cursor.below) {
            while cursor.slot >= FIRST_SLOT {
                let slot = self.read_slot(sector, cursor.slot);
                cursor.slot = cursor.slot.saturating_sub(1);
                let id = slot.claimed_id();
                if !cursor.seen.contains(&id) && slot.is_intact() && cursor.seen.push(id).is_ok() {
                    return Some(slot);
                }
            }
            cursor.below = generation;
            cursor.slot = LAST_SLOT;
        }
        None
    }

    pub(super) fn read_head(&mut self, sector: u8) -> Head {
        Head {
            bytes: self.read_slot(sector, 0).bytes,
        }
    }

    /// Reads a slot. An unreadable slot is neither blank nor a record.
    #[inline(never)]
    pub(super) fn read_slot(&mut self, sector: u8, slot: u8) -> Slot {
        let mut bytes = [0; SLOT_BYTES];
        if self.flash.read(offset(sector, slot), &mut bytes).is_err() {
            bytes = [0; SLOT_BYTES];
        }
        Slot { bytes }
    }
}
