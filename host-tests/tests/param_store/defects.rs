//! Cells and sectors that no longer work. Errors end, nothing is lost, and the rest remains in use.

use robot_app::{
    domain::{FlashRequest, ParamError},
    params::{Progress, Store},
};
use robot_plant::flash_chip::{EraseFault, FlashChip, PARAMETER_SECTORS, StuckBit, sector_range};

use crate::{
    bench::{BootedStore, Contents, Ledger, boot, new_chip, record, save_all},
    workload::nth_save,
};

const SECTOR_1: u32 = 0x0800_4000;
const SECTOR_BYTES: u32 = 0x4000;

/// Saves as the firmware does, with retries after errors, and returns the number of saves.
fn save_with_retries(
    store: &mut BootedStore,
    ledger: &mut Ledger,
    count: usize,
    errors: &mut Vec<ParamError>,
) {
    let record = nth_save(count);
    ledger.begun.push(record.clone());
    for _ in 0..1000 {
        match store.work(Some(&record)) {
            Ok(Progress::Stored) => {
                ledger.begun.clear();
                ledger
                    .saved
                    .insert((record.id.key, record.id.variant), record);
                return tidy_with_retries(store, errors);
            }
            Ok(Progress::Worked) => {}
            Err(error) => errors.push(error),
        }
    }
    panic!("save {count} never succeeds: {errors:?}");
}

/// Some tries; a store may go on wanting an erase that never works.
fn tidy_with_retries(store: &mut BootedStore, errors: &mut Vec<ParamError>) {
    for _ in 0..4 {
        if store.next(false) == FlashRequest::None {
            return;
        }
        errors.extend(store.work(None).err());
    }
}

/// Saves from one boot to the next: some sessions outlast several sectors.
const SESSIONS: [usize; 8] = [50, 30, 10, 300, 50, 1, 150, 60];

/// Five rotations with a boot now and then; returns the errors.
fn use_for_long(chip: &mut FlashChip, contents: Contents) -> Vec<ParamError> {
    let mut ledger = Ledger::of(contents);
    let mut errors = Vec::new();
    let mut count = 5_000;
    for session in SESSIONS {
        let mut store = Store::open(&mut *chip);
        for _ in 0..session {
            count += 1;
            save_with_retries(&mut store, &mut ledger, count, &mut errors);
        }
        let (store, found) = boot(chip).unwrap_or_else(|error| panic!("boot: {error:?}"));
        assert_eq!(store.report().lost_sectors, 0, "after {count}");
        assert_eq!(ledger.first_loss(&found), None, "after {count}");
    }
    errors
}

fn in_use() -> (FlashChip, Contents) {
    let mut chip = new_chip(9);
    // Some that never change again, and so must move along each time.
    let lasting = (100..106).map(|key| record(key, 1, 1, &[u32::from(key) << 24, 0, u32::MAX, 0]));
    let records: Vec<_> = lasting.chain((0..54).map(nth_save)).collect();
    let contents = save_all(&mut chip, &records);
    (chip, contents)
}

/// One bit is stuck at 0 or at 1, in each word of a slot and of the three heads in turn.
#[test]
fn a_stuck_bit_costs_at_most_a_sector_and_no_record() {
    let mut errors = 0;
    for value in [false, true] {
        for word in 0..32 {
            for (sector, slot) in [(0, 61), (0, 90), (1, 3), (1, 15), (2, 0), (1, 0)] {
                let (mut chip, contents) = in_use();
                let address = SECTOR_1 + sector * SECTOR_BYTES + slot * 128 + word * 4 + word % 4;
                let bit = (word % 8) as u8;
                chip.stick(StuckBit {
                    address,
                    bit,
                    value,
                });
                let found = use_for_long(&mut chip, contents);
                assert!(
                    found.len() < 20,
                    "{sector} {slot} {word} {value}: {found:?}"
                );
                errors += found.len();
            }
        }
    }
    println!("384 stuck bits, 650 saves each: {errors} failed attempts, 0 records lost");
    assert!(errors > 0);
}

/// A bit of the version is stuck in every slot, so the sector takes no record.
#[test]
fn a_sector_that_takes_no_record_is_skipped() {
    for sector in 1..3 {
        let (mut chip, contents) = in_use();
        for slot in 1..128 {
            let address = SECTOR_1 + sector * SECTOR_BYTES + slot * 128 + 5;
            let (bit, value) = (7, true);
            chip.stick(StuckBit {
                address,
                bit,
                value,
            });
        }
        let errors = use_for_long(&mut chip, contents);
        // A session meets it once, and does not try long.
        assert!(!errors.is_empty());
        assert!(errors.len() <= 3 * SESSIONS.len(), "{errors:?}");
    }
}

/// Both copies of the head have a stuck bit, so their sector can never be active.
#[test]
fn a_sector_that_takes_no_head_is_skipped() {
    for sector in 1..3 {
        let (mut chip, contents) = in_use();
        for copy in [8, 24] {
            let address = SECTOR_1 + sector * SECTOR_BYTES + copy + 4;
            // A bit in the lowest bytes of the generation, which are small numbers.
            let (bit, value) = (7, true);
            chip.stick(StuckBit {
                address,
                bit,
                value,
            });
        }
        let errors = use_for_long(&mut chip, contents);
        assert!(errors.contains(&ParamError::NotProgrammed));
        // It is tried again after a boot at most.
        assert!(errors.len() <= SESSIONS.len(), "{errors:?}");
    }
}

/// A bit of the mark is stuck. Each boot would find the sector not clean, and erase it in vain.
#[test]
fn a_sector_that_takes_no_mark_is_not_erased_at_each_boot() {
    for sector in PARAMETER_SECTORS {
        let (mut chip, contents) = in_use();
        let address = sector_range(sector).expect("a sector").start;
        let (bit, value) = (1, true);
        chip.stick(StuckBit {
            address,
            bit,
            value,
        });
        use_for_long(&mut chip, contents);
        let erases = |chip: &FlashChip| PARAMETER_SECTORS.map(|sector| chip.erases(sector)).sum();
        let before: u32 = erases(&chip);
        for _ in 0..20 {
            tidy_with_retries(&mut Store::open(&mut chip), &mut Vec::new());
        }
        assert!(erases(&chip) - before <= 2, "{sector}");
    }
}

#[test]
fn a_sector_that_cannot_be_erased_is_skipped() {
    for fault in [EraseFault::DoesNothing, EraseFault::LeavesSomeWords] {
        for sector in PARAMETER_SECTORS {
            let (mut chip, contents) = in_use();
            chip.set_erase_fault(sector, Some(fault));
            let errors = use_for_long(&mut chip, contents);
            assert!(errors.contains(&ParamError::NotErased));
            assert!(errors.iter().all(|error| *error == ParamError::NotErased));
            // One try after each boot at most.
            assert!(errors.len() <= SESSIONS.len(), "{sector}: {errors:?}");
        }
    }
}

/// Nothing can be erased. What fits is saved; after that every attempt reports why it fails, and the records stay.
#[test]
fn with_no_erase_working_the_store_fills_up_and_stays_readable() {
    let (mut chip, contents) = in_use();
    for sector in PARAMETER_SECTORS {
        chip.set_erase_fault(sector, Some(EraseFault::DoesNothing));
    }
    let mut ledger = Ledger::of(contents);
    let mut store = Store::open(&mut chip);
    // The rest of this sector, and the one that is clean already.
    for count in 0..67 + 127 - 18 {
        save_with_retries(&mut store, &mut ledger, count, &mut Vec::new());
    }
    for count in 0..20 {
        let failed = store.work(Some(&nth_save(7_000 + count)));
        assert_eq!(failed, Err(ParamError::NotErased));
    }
    let (_, found) = boot(&mut chip).expect("boots");
    assert_eq!(ledger.first_loss(&found), None);
}
