//! The same settings kept by the robot's own store.

use robot_app::{
    domain::FlashRequest,
    params::{Progress, Record, RecordId, Store},
};
use robot_plant::flash_chip::FlashChip;

use crate::settings::{Found, KEYS, Keeper, Save};

/// More steps than any save or clean-up takes.
const MANY_STEPS: usize = 400;

pub struct OwnStore;

fn record(save: Save) -> Record {
    let value = save.value();
    let words = value.as_chunks().0.iter().copied().map(u32::from_le_bytes);
    Record {
        id: RecordId {
            key: save.key,
            variant: 0,
        },
        version: 1,
        values: words.collect(),
    }
}

/// Steps without a record, while they ask for `wanted`. False once one fails.
fn work(store: &mut Store<&mut FlashChip>, wanted: fn(FlashRequest) -> bool) -> bool {
    for _ in 0..MANY_STEPS {
        if !wanted(store.next(false)) {
            return true;
        }
        if store.work(None).is_err() {
            return false;
        }
    }
    false
}

impl Keeper for OwnStore {
    /// Works as the firmware does: it completes what a cut left unfinished, saves, and then erases the sector that the next
    /// rotation needs.
    fn save(&self, chip: &mut FlashChip, save: Save) -> bool {
        let mut store = Store::open(chip);
        let record = record(save);
        let stored = (0..MANY_STEPS).any(|_| store.work(Some(&record)) == Ok(Progress::Stored));
        // The save is confirmed, whatever becomes of the rest.
        let _ = work(&mut store, |request| request != FlashRequest::None);
        stored
    }

    fn load(&self, chip: &mut FlashChip) -> [Found; KEYS as usize] {
        let mut found = [Found::Nothing; KEYS as usize];
        let mut store = Store::open(chip);
        if !work(&mut store, |request| request == FlashRequest::Program) {
            return [Found::Error; KEYS as usize];
        }
        store.for_each(|record| {
            let value: Vec<u8> = record.values.iter().flat_map(|v| v.to_le_bytes()).collect();
            if let Some(place) = found.get_mut(usize::from(record.id.key)) {
                *place = Found::parse(record.id.key, &value);
            }
        });
        found
    }
}
