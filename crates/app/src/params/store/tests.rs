use embedded_storage::nor_flash::{ErrorType, NorFlashErrorKind, ReadNorFlash};

use super::*;
use crate::params::{
    RecordId,
    sector::{CLEAN, offset},
};

const SIZE: usize = 3 * 0x4000;

/// Bits go from 1 to 0, and every operation is noted.
struct Cells {
    bytes: Vec<u8>,
    /// Offset and length of what was programmed; an erase has length 0.
    log: Vec<(u32, usize)>,
    /// Bits that are 1 after each write, in the byte at that offset.
    stuck: Vec<(u32, u8)>,
    /// A sector whose head reads as noise, whatever it holds.
    unreadable: Option<u8>,
    /// Sectors on which an erase does nothing.
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

/// Steps until the record is stored.
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
fn a_new_chip_wants_an_erase_and_then_nothing() {
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
fn opening_and_reading_writes_nothing() {
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
fn a_slot_is_programmed_guard_first_checksum_and_proof_last() {
    let mut cells = Cells::blank();
    save(&mut Store::open(&mut cells), &record(1, 10));
    cells.log.clear();
    save(&mut Store::open(&mut cells), &record(1, 11));
    let slot = offset(0, 2);
    let order = [(slot, 4), (slot + 4, 8), (slot + 124, 4), (slot + 120, 4)];
    assert_eq!(cells.log, order);
}

#[test]
fn a_full_sector_moves_on_head_last_and_an_erase_follows() {
    let mut cells = Cells::blank();
    let mut store = Store::open(&mut cells);
    for value in 0..127 {
        save(&mut store, &record((value % 3) as u8, value));
        tidy(&mut store);
    }
    assert_eq!(store.report().free_slots, 0);
    assert_eq!(store.next(false), FlashRequest::None);
    store.flash.log.clear();
    // Opens, moves three, writes the head, appends.
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
fn a_slot_that_does_not_take_a_record_is_left_behind() {
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

/// The older copy of a damaged record is taken, in the same sector and in the backup.
#[test]
fn a_damaged_record_falls_back_to_its_older_copy() {
    let mut cells = Cells::blank();
    let mut store = Store::open(&mut cells);
    for value in 0..128 {
        save(&mut store, &record(1, value));
        tidy(&mut store);
    }
    // The moved copy of 126 and the new 127 are all there is in the active sector.
    for (damaged, found) in [(2, 126), (1, 126)] {
        cells.bytes[offset(1, damaged) as usize + 8] ^= 1;
        assert_eq!(values(&mut Store::open(&mut cells)), [(1, found)]);
    }
    assert_eq!(Store::open(&mut cells).report().damaged, 2);
}

/// It read as a head at boot, but programming it again breaks it.
#[test]
fn records_leave_a_sector_whose_head_cannot_be_made_to_last() {
    let mut cells = Cells::blank();
    let mut store = Store::open(&mut cells);
    save(&mut store, &record(1, 10));
    tidy(&mut store);
    // A power cut before the proof.
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

/// Saves until the `generation`-th sector is active, with the last value in it.
fn fill<F: NorFlash>(store: &mut Store<F>, generation: u32) -> u32 {
    let mut value = 0;
    while store.report().generation < generation {
        value += 1;
        save(store, &record(1, value));
        tidy(store);
    }
    value
}

/// Bits of the header stay 1 in these slots: none takes a record.
fn wear_out(cells: &mut Cells, sector: u8, slots: core::ops::RangeInclusive<u8>) {
    let stuck = slots.map(|slot| (offset(sector, slot) + 5, 0x80));
    cells.stuck.extend(stuck);
}

/// Errors until the record is stored, as often as it takes.
fn save_stubbornly<F: NorFlash>(store: &mut Store<F>, record: &Record) -> Vec<ParamError> {
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

/// Its records are gone for a boot. What is saved in that boot must not be hidden when they come back.
#[test]
fn a_head_that_can_be_read_again_hides_nothing_saved_meanwhile() {
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

/// The same, but what is saved meanwhile is appended: the older sector is not full.
#[test]
fn nor_does_it_hide_what_was_appended_to_an_older_sector() {
    let mut cells = Cells::blank();
    save(&mut Store::open(&mut cells), &record(1, 10));
    tidy(&mut Store::open(&mut cells));
    wear_out(&mut cells, 0, 2..=4);
    save_stubbornly(&mut Store::open(&mut cells), &record(1, 11));
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
fn after_three_failures_a_record_goes_to_the_next_sector() {
    let mut cells = Cells::blank();
    save(&mut Store::open(&mut cells), &record(1, 10));
    tidy(&mut Store::open(&mut cells));
    wear_out(&mut cells, 0, 2..=127);
    let mut store = Store::open(&mut cells);
    let errors = save_stubbornly(&mut store, &record(1, 11));
    assert_eq!(errors, [ParamError::NotProgrammed; 3]);
    assert_eq!(store.report().generation, 2);
    assert_eq!(values(&mut store), [(1, 11)]);
    assert_eq!(save_stubbornly(&mut store, &record(1, 12)), []);
}

#[test]
fn after_three_failures_a_change_of_sectors_takes_another_target() {
    let mut cells = Cells::blank();
    fill(&mut Store::open(&mut cells), 1);
    wear_out(&mut cells, 1, 1..=127);
    let mut store = Store::open(&mut cells);
    for value in 100..226 {
        assert_eq!(save_stubbornly(&mut store, &record(1, value)), []);
        tidy(&mut store);
    }
    assert_eq!(store.report().free_slots, 0);
    let errors = save_stubbornly(&mut store, &record(1, 1000));
    assert_eq!(errors, [ParamError::NotProgrammed; 3]);
    assert_eq!(values(&mut store), [(1, 1000)]);
    assert!(matches!(
        store.sectors[2].state,
        SectorState::Headed { generation: 2 }
    ));
}

/// There is no other sector: slots behind the worn ones are tried on.
#[test]
fn with_no_other_sector_the_worn_one_goes_on_being_tried() {
    let mut cells = Cells::blank();
    save(&mut Store::open(&mut cells), &record(1, 10));
    wear_out(&mut cells, 0, 2..=9);
    cells.bytes[offset(1, 0) as usize..].fill(0x5A);
    cells.worn = vec![1, 2];
    let mut store = Store::open(&mut cells);
    let errors = save_stubbornly(&mut store, &record(1, 11));
    let of = |wanted| errors.iter().filter(|error| **error == wanted).count();
    assert_eq!(of(ParamError::NotProgrammed), 8);
    assert_eq!(of(ParamError::NotErased), 2);
    assert_eq!(values(&mut store), [(1, 11)]);
}

/// The active head breaks while it is proven, and the third sector cannot be erased: the backup is all there is.
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
    // A power cut before the proof, and a third sector that is worn out.
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
    // At the next boot the head is gone, and what was moved there is found where it came from.
    let mut store = Store::open(&mut cells);
    assert_eq!(store.report().generation, 1);
    assert_eq!(values(&mut store), [(1, 127)]);
}

#[test]
fn a_sector_is_clean_only_if_all_of_it_is_blank() {
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
fn what_a_cut_left_of_a_record_is_cleared_for_good() {
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
