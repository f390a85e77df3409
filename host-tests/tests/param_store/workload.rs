//! The saves in which the power is cut: twelve records, from one value to eight, over three changes of sector.

use robot_app::params::Record;
use robot_plant::flash_chip::FlashChip;

use crate::bench::{Contents, Ledger, boot, new_chip, record, save_all, tidy};

const KEYS: u8 = 12;
/// Number of slots in a sector.
const SLOTS: usize = 127;
/// The saves fill the last slots of the first sector, two whole sectors and the beginning of a fourth.
const BEFORE: usize = SLOTS - 10;
const CHANGES_OF_SECTOR: usize = 3;

/// The save with number `count`.
pub fn nth_save(count: usize) -> Record {
    let key = (count * 5 % usize::from(KEYS)) as u8;
    let length = [1, 1, 2, 1, 3, 1, 8, 1, 2, 1, 4, 1][usize::from(key)];
    let word = |index: u32| (count as u32).wrapping_mul(0x9E37_79B9) ^ index << 28;
    let values: Vec<u32> = (0..length).map(word).collect();
    record(key, key % 3, 1, &values)
}

/// One save, from the end of the previous save and its clean-up.
pub struct Moment {
    pub chip: FlashChip,
    /// The contents that it must have.
    pub contents: Contents,
    pub record: Record,
    /// The chip's first step of the save, and its first step after it.
    pub steps: std::ops::Range<u64>,
}

impl Moment {
    /// Saves `record`. `contents` holds the required contents of the chip before, and is updated to those after.
    pub fn at(chip: &mut FlashChip, contents: &mut Contents, record: Record) -> Self {
        let mut moment = Self {
            chip: chip.clone(),
            contents: contents.clone(),
            record,
            steps: chip.steps()..0,
        };
        *contents = moment.run(chip).saved;
        moment.steps.end = chip.steps();
        moment
    }

    /// Runs the save and its clean-up, until the end or the power cut.
    pub fn run(&self, chip: &mut FlashChip) -> Ledger {
        let mut ledger = Ledger::of(self.contents.clone());
        if let Ok((mut store, _)) = boot(chip)
            && ledger.save(&mut store, &self.record).is_ok()
        {
            // A power cut ends the work at that point.
            let _ = tidy(&mut store);
        }
        ledger
    }
}

/// All saves of the workload, and the number of changes of the active sector.
pub fn moments() -> Vec<Moment> {
    let mut chip = new_chip(1);
    let before: Vec<_> = (0..BEFORE).map(nth_save).collect();
    let mut contents = save_all(&mut chip, &before);
    let end = BEFORE + 14 + (CHANGES_OF_SECTOR - 1) * (SLOTS - usize::from(KEYS));
    let mut moments = Vec::new();
    let first = generation(&mut chip);
    for count in BEFORE..end {
        moments.push(Moment::at(&mut chip, &mut contents, nth_save(count)));
    }
    let changes = generation(&mut chip) - first;
    assert_eq!(changes as usize, CHANGES_OF_SECTOR);
    moments
}

fn generation(chip: &mut FlashChip) -> u32 {
    let (store, _) = boot(chip).expect("a good chip");
    store.report().generation
}
