use embedded_storage::nor_flash::{ErrorType, NorFlashErrorKind, ReadNorFlash};

use super::*;
use crate::params::{
    RecordId,
    sector::{CLEAN, offset},
};

const SIZE: usize = 3 * 0x4000;

/// Flash cells whose bits go from 1 to 0, with a log of all operations.
struct Cells {
    bytes: Vec<u8>,
    /// Offset and length of each programming operation; an erase has length 0.
    log: Vec<(u32, usize)>,
    /// Bits that stay 1 in the byte at that offset.
    stuck: Vec<(u32, u8)>,
    /// A sector whose head reads as noise.
    unreadable: Option<u8>,
    /// Sectors on which an erase has no effect.
    worn: Vec<u8>,
}

type Vec<T> = std::vec::Vec<T>;

impl Cells {
    fn blank() -> Self {
        Self {
            bytes: vec![0xFF; SIZE],
            log: Vec::new(),
            stuck: Vec::new(),
            unreadable: None,
            worn: Vec::new(),
        }
    }
}

impl ErrorType for Cells {
    type Error = NorFlashErrorKind;
}

impl ReadNorFlash for Cells {
    const READ_SIZE: usize = 1;

    fn read(&mut self, place: u32, bytes: &mut [u8]) -> Result<(), NorFlashErrorKind> {
        bytes.copy_from_slice(&self.bytes[place as usize..][..bytes.len()]);
        if self.unreadable.map(|sector| offset(sector, 0)) == Some(place) {
            bytes.fill(0x5A);
        }
        Ok(())
    }

    fn capacity(&self) -> usize {
        SIZE
    }
}

impl NorFlash for Cells {
    const WRITE_SIZE: usize = 4;
    const ERASE_SIZE: usize = 0x4000;

    fn erase(&mut self, from: u32, to: u32) -> Result<(), NorFlashErrorKind> {
        self.log.push((from, 0));
        if !self.worn.iter().any(|sector| offset(*sector, 0) == from) {
            self.bytes[from as usize..to as usize].fill(0xFF);
        }
        Ok(())
    }

    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), NorFlashErrorKind> {
        assert!(offset.is_multiple_of(4) && bytes.len().is_multiple_of(4));
        self.log.push((offset, bytes.len()));
        for (cell, byte) in self.bytes[offset as usize..].iter_mut().zip(bytes) {
            *cell &= byte;
        }
        for (stuck, ones) in &self.stuck {
            self.bytes[*stuck as usize] |= ones;
        }
        Ok(())
    }
}

fn record(key: u8, value: u32) -> Record {
    Record {
        id: RecordId { key, variant: 0 },
        version: 1,
        values: [value].into_iter().collect(),
    }
}

/// Number of steps until the record is stored.
fn save<F: NorFlash>(store: &mut Store<F>, record: &Record) -> usize {
    for steps in 1..300 {
        if store.work(Some(record)) == Ok(Progress::Stored) {
            return steps;
        }
    }
    panic!("never stored");
}

fn tidy<F: NorFlash>(store: &mut Store<F>) {
    while store.next(false) != FlashRequest::None {
        assert_eq!(store.work(None), Ok(Progress::Worked));
    }
}

fn values<F: NorFlash>(store: &mut Store<F>) -> Vec<(u8, u32)> {
    let mut found = Vec::new();
    store.for_each(|record| found.push((record.id.key, record.values[0])));
    found.sort_unstable();
    found
}

#[test]
fn a_new_chip_requests_one_erase() {
    let mut cells = Cells::blank();
    let mut store = Store::open(&mut cells);
    assert_eq!(store.report(), StoreReport::default());
    assert_eq!(store.next(false), FlashRequest::Erase);
    assert_eq!(store.next(true), FlashRequest::Erase);
    assert_eq!(store.work(None), Ok(Progress::Worked));
    assert_eq!(store.next(false), FlashRequest::None);
    assert_eq!(store.work(None), Ok(Progress::Worked));
    assert_eq!(store.next(true), FlashRequest::Program);
    let erases = cells.log.iter().filter(|(_, length)| *length == 0);
    assert_eq!(erases.count(), 1);
}

#[test]
fn opening_and_reading_write_nothing() {
    let mut cells = Cells::blank();
    save(&mut Store::open(&mut cells), &record(1, 10));
    cells.log.clear();
    let mut store = Store::open(&mut cells);
    assert_eq!(values(&mut store), [(1, 10)]);
    assert_eq!(store.report().free_slots, 126);
    assert_eq!(store.report().generation, 1);
    assert!(cells.log.is_empty());
}

#[test]
fn a_slot_is_programmed_with_guard_first_and_checksum_and_proof_last() {
    let mut cells = Cells::blank();
    save(&mut Store::open(&mut cells), &record(1, 10));
    cells.log.clear();
    save(&mut Store::open(&mut cells), &record(1, 11));
    let slot = offset(0, 2);
    let order = [(slot, 4), (slot + 4, 8), (slot + 124, 4), (slot + 120, 4)];
    assert_eq!(cells.log, order);
}

#[test]
fn a_full_sector_is_rotated_with_the_head_last_and_an_erase_after_it() {
    let mut cells = Cells::blank();
    let mut store = Store::open(&mut cells);
    for value in 0..127 {
        save(&mut store, &record((value % 3) as u8, value));
        tidy(&mut store);
    }
    assert_eq!(store.report().free_slots, 0);
    assert_eq!(store.next(false), FlashRequest::None);
    store.flash.log.clear();
    // The steps open the sector, copy three records, write the head, and append.
    assert_eq!(save(&mut store, &record(0, 1000)), 6);
    assert_eq!(store.next(false), FlashRequest::Erase);
    let report = store.report();
    assert_eq!((report.generation, report.free_slots), (2, 123));
    assert_eq!(values(&mut store), [(0, 1000), (1, 124), (2, 125)]);
    let first = |wanted| cells.log.iter().position(|(at, _)| *at == wanted);
    let head = first(offset(1, 0) + 8).unwrap();
    assert_eq!(first(offset(1, 0) + 4), Some(0));
    assert!(first(offset(1, 3) + 120).unwrap() < head);
    assert!(first(offset(1, 4)).unwrap() > head);
}

/// A bit of the first value cannot be cleared.
#[test]
fn a_slot_that_does_not_take_a_record_is_skipped() {
    let mut cells = Cells::blank();
    save(&mut Store::open(&mut cells), &record(1, 10));
    cells.stuck.push((offset(0, 2) + 8, 0x80));
    let mut store = Store::open(&mut cells);
    assert_eq!(
        store.work(Some(&record(1, 11))),
        Err(ParamError::NotProgrammed)
    );
    assert_eq!(values(&mut store), [(1, 10)]);
    assert!(save(&mut store, &record(1, 11)) <= 2);
    assert_eq!(values(&mut store), [(1, 11)]);
    let mut again = Store::open(&mut cells);
    assert_eq!(values(&mut again), [(1, 11)]);
    assert_eq!(again.report().damaged, 1);
    assert_eq!(again.next(false), FlashRequest::Erase);
}

/// The older copy is found both in the same sector and in the backup.
#[test]
fn a_damaged_record_falls_back_to_its_older_copy() {
    let mut cells = Cells::blank();
    let mut store = Store::open(&mut cells);
    for value in 0..128 {
        save(&mut store, &record(1, value));
        tidy(&mut store);
    }
    // The active sector holds only the copy of 126 and the new 127.
    for (damaged, found) in [(2, 126), (1, 126)] {
        cells.bytes[offset(1, damaged) as usize + 8] ^= 1;
        assert_eq!(values(&mut Store::open(&mut cells)), [(1, found)]);
    }
    assert_eq!(Store::open(&mut cells).report().damaged, 2);
}

/// The head was readable at boot, but programming it again breaks it.
#[test]
fn a_sector_with_an_unreliable_head_is_rotated() {
    let mut cells = Cells::blank();
    let mut store = Store::open(&mut cells);
    save(&mut store, &record(1, 10));
    tidy(&mut store);
    // A power cut came before the proof.
    cells.bytes[40..44].fill(0xFF);
    cells.stuck = vec![(10, 0xFF), (26, 0xFF)];
    let mut store = Store::open(&mut cells);
    assert_eq!(store.next(false), FlashRequest::Program);
    assert_eq!(store.work(None), Err(ParamError::NotProgrammed));
    assert_eq!(store.report().free_slots, 0);
    save(&mut store, &record(2, 20));
    assert_eq!(store.report().generation, 2);
    assert_eq!(values(&mut store), [(1, 10), (2, 20)]);
    assert_eq!(values(&mut Store::open(&mut cells)), [(1, 10), (2, 20)]);
}

/// Saves until the sector of this generation is active, and returns its last value.
fn fill<F: NorFlash>(store: &mut Store<F>, generation: u32) -> u32 {
    let mut value = 0;
    while store.report().generation < generation {
        value += 1;
        save(store, &record(1, value));
        tidy(store);
    }
    value
}

/// Makes bits of the header stay 1 in these slots, so they take no record.
fn wear_out(cells: &mut Cells, sector: u8, slots: core::ops::RangeInclusive<u8>) {
    let stuck = slots.map(|slot| (offset(sector, slot) + 5, 0x80));
    cells.stuck.extend(stuck);
}

/// Repeats the save until the record is stored, and returns the errors.
fn save_with_retries<F: NorFlash>(store: &mut Store<F>, record: &Record) -> Vec<ParamError> {
    let mut errors = Vec::new();
    for _ in 0..1000 {
        match store.work(Some(record)) {
            Ok(Progress::Stored) => return errors,
            Ok(Progress::Worked) => {}
            Err(error) => errors.push(error),
        }
    }
    panic!("never stored: {errors:?}");
}

/// Its records are missing in one boot. What is saved in that boot must not be hidden when they return.
#[test]
fn a_head_that_becomes_readable_hides_no_later_record() {
    let mut cells = Cells::blank();
    fill(&mut Store::open(&mut cells), 2);
    cells.unreadable = Some(1);
    let mut store = Store::open(&mut cells);
    assert_eq!(
        (store.report().generation, store.report().lost_sectors),
        (1, 1)
    );
    save(&mut store, &record(1, 9_999));
    cells.unreadable = None;
    let mut store = Store::open(&mut cells);
    assert_eq!(values(&mut store), [(1, 9_999)]);
    assert_eq!(store.report().lost_sectors, 0);
}

/// The record is appended this time, as the older sector is not full.
#[test]
fn a_head_that_becomes_readable_hides_no_record_appended_elsewhere() {
    let mut cells = Cells::blank();
    save(&mut Store::open(&mut cells), &record(1, 10));
    tidy(&mut Store::open(&mut cells));
    wear_out(&mut cells, 0, 2..=4);
    save_with_retries(&mut Store::open(&mut cells), &record(1, 11));
    cells.stuck.clear();
    cells.unreadable = Some(1);
    let mut store = Store::open(&mut cells);
    assert_eq!(values(&mut store), [(1, 10)]);
    save(&mut store, &record(2, 20));
    assert_eq!(store.report().generation, 1);
    cells.unreadable = None;
    assert_eq!(values(&mut Store::open(&mut cells)), [(1, 10), (2, 20)]);
}

#[test]
fn after_three_failures_a_record_is_saved_in_the_next_sector() {
    let mut cells = Cells::blank();
    save(&mut Store::open(&mut cells), &record(1, 10));
    tidy(&mut Store::open(&mut cells));
    wear_out(&mut cells, 0, 2..=127);
    let mut store = Store::open(&mut cells);
    let errors = save_with_retries(&mut store, &record(1, 11));
    assert_eq!(errors, [ParamError::NotProgrammed; 3]);
    assert_eq!(store.report().generation, 2);
    assert_eq!(values(&mut store), [(1, 11)]);
    assert_eq!(save_with_retries(&mut store, &record(1, 12)), []);
}

#[test]
fn after_three_failures_a_rotation_takes_another_sector() {
    let mut cells = Cells::blank();
    fill(&mut Store::open(&mut cells), 1);
    wear_out(&mut cells, 1, 1..=127);
    let mut store = Store::open(&mut cells);
    for value in 100..226 {
        assert_eq!(save_with_retries(&mut store, &record(1, value)), []);
        tidy(&mut store);
    }
    assert_eq!(store.report().free_slots, 0);
    let errors = save_with_retries(&mut store, &record(1, 1000));
    assert_eq!(errors, [ParamError::NotProgrammed; 3]);
    assert_eq!(values(&mut store), [(1, 1000)]);
    assert!(matches!(
        store.sectors[2].state,
        SectorState::Headed { generation: 2 }
    ));
}

/// Without another sector, the slots behind the worn ones are tried.
#[test]
fn without_another_sector_the_worn_one_is_tried_further() {
    let mut cells = Cells::blank();
    save(&mut Store::open(&mut cells), &record(1, 10));
    wear_out(&mut cells, 0, 2..=9);
    cells.bytes[offset(1, 0) as usize..].fill(0x5A);
    cells.worn = vec![1, 2];
    let mut store = Store::open(&mut cells);
    let errors = save_with_retries(&mut store, &record(1, 11));
    let of = |wanted| errors.iter().filter(|error| **error == wanted).count();
    assert_eq!(of(ParamError::NotProgrammed), 8);
    assert_eq!(of(ParamError::NotErased), 2);
    assert_eq!(values(&mut store), [(1, 11)]);
}

/// The active head breaks while it is verified, and the third sector cannot be erased, so only the backup remains.
#[test]
fn the_backup_of_a_broken_head_is_not_erased() {
    let mut cells = Cells::blank();
    let mut store = Store::open(&mut cells);
    for value in 1..=127 {
        save(&mut store, &record(1, value));
        tidy(&mut store);
    }
    while store.report().generation < 2 {
        assert_eq!(store.work(Some(&record(1, 128))), Ok(Progress::Worked));
    }
    // A power cut came before the proof, and the third sector is worn out.
    cells.bytes[offset(1, 0) as usize + 40..][..4].fill(0xFF);
    cells.bytes[offset(2, 0) as usize..].fill(0x5A);
    cells.stuck = [10, 26].map(|at| (offset(1, 0) + at, 0xFF)).into();
    cells.worn = vec![2];
    let mut store = Store::open(&mut cells);
    assert_eq!(store.work(None), Err(ParamError::NotProgrammed));
    for _ in 0..10 {
        let _ = store.work(Some(&record(2, 20)));
    }
    assert_eq!(values(&mut store), [(1, 127)]);
    // At the next boot the head is gone, and its records are found in the backup.
    let mut store = Store::open(&mut cells);
    assert_eq!(store.report().generation, 1);
    assert_eq!(values(&mut store), [(1, 127)]);
}

#[test]
fn a_sector_is_clean_only_if_it_is_entirely_blank() {
    let mut cells = Cells::blank();
    cells.bytes[..CLEAN.len()].copy_from_slice(&CLEAN);
    assert_eq!(Store::open(&mut cells).next(false), FlashRequest::None);
    cells.bytes[0x3FFF] = 0x7F;
    assert_eq!(Store::open(&mut cells).next(false), FlashRequest::Erase);
    // Only the head, which was cleared before, is not blank after the erase.
    let mut cells = Cells::blank();
    cells.worn = vec![0, 1, 2];
    let mut store = Store::open(&mut cells);
    assert_eq!(store.work(None), Err(ParamError::NotErased));
}

/// Word 3 of the last slot was torn, and nothing after it was programmed.
#[test]
fn the_remains_of_an_interrupted_record_are_cleared() {
    let mut cells = Cells::blank();
    save(&mut Store::open(&mut cells), &record(1, 0x55));
    let sector = Store::open(&mut cells).active_sector().unwrap().0;
    let slot = offset(sector, 1) as usize;
    cells.bytes[slot + 12..slot + 128].fill(0xFF);
    cells.bytes[slot + 12] = 0xFE;
    tidy(&mut Store::open(&mut cells));
    assert_eq!(cells.bytes[slot + 4..slot + 120], [0; 116]);
    assert_eq!(values(&mut Store::open(&mut cells)), []);
}
