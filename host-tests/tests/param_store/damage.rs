//! Flipped bits, garbage and arbitrary images: a boot always succeeds and the next save works.

use proptest::{prelude::*, test_runner::Config};
use robot_app::params::Store;
use robot_plant::flash_chip::{FlashChip, PARAMETER_SECTORS, sector_range};

use crate::{
    bench::{Contents, Ledger, boot, identity, new_chip, record, save, save_all, tidy},
    workload::nth_save,
};

const SECTOR: usize = 16 * 1024;
const SLOT: usize = 128;
/// Position of the second sector's head, counted in slots.
const ACTIVE_HEAD: usize = SECTOR / SLOT;
/// Address of sector 1.
const SECTOR_1: u32 = 0x0800_4000;

/// Checks a store after damage: it boots, it saves, and later boots find what it saved.
fn works_again(chip: &mut FlashChip) {
    let (_, found) = boot(chip).expect("boots whatever there is");
    let mut ledger = Ledger::of(found);
    let (mut store, _) = boot(chip).expect("boots");
    // Enough for the sector to change, so that what is damaged is met again.
    for count in 0..140 {
        let saved = ledger.save(&mut store, &nth_save(count));
        assert_eq!(saved, Ok(()));
        assert_eq!(tidy(&mut store), Ok(()));
    }
    let (_, found) = boot(chip).expect("boots");
    assert_eq!(ledger.first_loss(&found), None);
}

/// The first sector is the backup, the second the active one, the third is clean.
fn two_sectors_in_use() -> (FlashChip, Contents) {
    let mut chip = new_chip(5);
    let records: Vec<_> = (0..170).map(nth_save).collect();
    let contents = save_all(&mut chip, &records);
    (chip, contents)
}

fn image(chip: &mut FlashChip) -> Vec<u8> {
    let mut bytes = vec![0; 3 * SECTOR];
    chip.read(SECTOR_1, &mut bytes).expect("powered");
    bytes
}

fn put(chip: &mut FlashChip, bytes: &[u8]) {
    chip.set_contents(SECTOR_1, bytes).expect("in range");
}

proptest! {
    #![proptest_config(Config::with_cases(300))]
    #[test]
    fn flipped_bits_cost_at_most_the_slots_they_are_in(
        flips in prop::collection::vec(0..3 * SECTOR * 8, 1..20),
    ) {
        let (mut chip, contents) = two_sectors_in_use();
        let mut bytes = image(&mut chip);
        let newest = contents.keys().map(|(key, _)| newest_slot(&bytes, *key));
        let newest: Vec<_> = newest.collect();
        for flip in &flips {
            bytes[flip / 8] ^= 1 << (flip % 8);
        }
        put(&mut chip, &bytes);
        let is_hurt = |slot: usize| flips.iter().any(|flip| flip / 8 / SLOT == slot);
        let (_, found) = boot(&mut chip).expect("boots");
        for ((identity, record), slot) in contents.iter().zip(newest) {
            if !is_hurt(slot) && !is_hurt(ACTIVE_HEAD) {
                prop_assert_eq!(found.get(identity), Some(record));
            }
        }
        works_again(&mut chip);
    }

    #[test]
    fn an_image_of_anything_boots_and_saves(
        seed in any::<u64>(),
        pattern in 0..4_u8,
    ) {
        let mut chip = FlashChip::parameters(seed);
        let mut bytes = noise(seed, 3 * SECTOR);
        for (index, byte) in bytes.iter_mut().enumerate() {
            match pattern {
                0 => {}
                1 => *byte = 0,
                2 => *byte |= 0xEF,
                _ if index % SECTOR >= 256 => *byte = 0xFF,
                _ => {}
            }
        }
        put(&mut chip, &bytes);
        works_again(&mut chip);
    }
}

/// Finds the newest slot of a key without the store: the last slot of the active sector with the key in its second word.
fn newest_slot(bytes: &[u8], key: u8) -> usize {
    let keys = bytes.chunks(SLOT).map(|slot| slot[4]).enumerate();
    let mut held = keys.skip(ACTIVE_HEAD + 1).take(127);
    let last = held.rfind(|(_, found)| *found == key);
    last.expect("each key is there").0
}

fn noise(seed: u64, length: usize) -> Vec<u8> {
    let mut state = seed | 1;
    (0..length)
        .map(|_| {
            // Knuth's MMIX generator; its high bits are good.
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 56) as u8
        })
        .collect()
}

/// Both heads are damaged and all else is intact. This was a store, and its settings are lost.
#[test]
fn two_damaged_heads_do_not_count_as_another_firmware() {
    let (mut chip, _) = two_sectors_in_use();
    for sector in PARAMETER_SECTORS.take(2) {
        let range = sector_range(sector).expect("a sector");
        for copy in [8, 24] {
            let garbage = noise((u64::from(sector) << 8) + copy, 16);
            let place = range.start + copy as u32;
            chip.set_contents(place, &garbage).expect("in range");
        }
    }
    let (store, found) = boot(&mut chip).expect("boots");
    assert!(found.is_empty());
    let report = store.report();
    assert_eq!((report.lost_sectors, report.strange_sectors), (2, 0));
}

/// Any one, two or three sectors are garbage, and the records of the others are found.
#[test]
fn garbage_in_whole_sectors_loses_only_their_records() {
    for broken in 0..8_u8 {
        let (mut chip, contents) = two_sectors_in_use();
        for (sector, bit) in PARAMETER_SECTORS.zip(0..) {
            if broken & 1 << bit != 0 {
                let range = sector_range(sector).expect("a sector");
                let garbage = noise(sector.into(), SECTOR);
                chip.set_contents(range.start, &garbage).expect("in range");
            }
        }
        let (store, found) = boot(&mut chip).expect("boots");
        // If the clean sector is damaged too, one of the two may be the result of an interrupted erase.
        let lost = [0, 1, 1, 0, 0, 1, 1, 0][usize::from(broken)];
        // If no valid sector is left, the noise counts as the data of another program.
        let strange = [0, 0, 0, 2, 0, 0, 0, 3][usize::from(broken)];
        let report = store.report();
        let told = (report.lost_sectors, report.strange_sectors);
        assert_eq!(told, (lost, strange), "{broken}");
        match broken & 3 {
            // The active one is whole.
            0 | 1 => assert_eq!(found, contents),
            // Only the backup is: what was in it is found, as it was then.
            2 => {
                let older: Contents = (0..127)
                    .map(nth_save)
                    .map(|record| (identity(&record), record))
                    .collect();
                assert_eq!(found, older);
            }
            _ => assert!(found.is_empty()),
        }
        works_again(&mut chip);
    }
}

/// No erase has finished in this sector, although it looks blank.
#[test]
fn a_sector_that_only_looks_blank_is_erased_before_use() {
    let mut chip = FlashChip::parameters(1);
    let mut store = Store::open(&mut chip);
    save(&mut store, &record(1, 0, 1, &[1])).expect("a good chip");
    let erases: u32 = PARAMETER_SECTORS.map(|sector| chip.erases(sector)).sum();
    assert_eq!(erases, 1);
}
