//! A bank: a header and two rings of records.

use super::{
    header::{Event, HEADER_WORDS, Header},
    memory::{BANK_WORDS, BlackBoxMemory, LAYOUT_VERSION},
    sample::{BlackBoxSample, FIRST_RECORD_WORDS, RECORD_WORDS, Record},
};

/// Records of the ring with all samples.
const FINE: usize = 155;
/// Records of the ring with every fifth of the older samples.
const COARSE: usize = 43;
/// One of so many samples that leave the fine ring is kept.
const THINNING: u32 = 5;
/// Largest number of samples in a bank.
pub const SAMPLES_A_BANK: usize = FINE + COARSE;

/// Samples in a bank of layout 1.
const FIRST_SAMPLES: usize = 223;

const _: () = assert!(HEADER_WORDS + SAMPLES_A_BANK * RECORD_WORDS <= BANK_WORDS);
const _: () = assert!(HEADER_WORDS + FIRST_SAMPLES * FIRST_RECORD_WORDS == BANK_WORDS);
// So that the thinned samples are evenly spaced.
const _: () = assert!((FINE as u32).is_multiple_of(THINNING));

/// Reads a bank. It shows only what its checksums prove.
#[derive(Clone, Copy, Debug)]
pub struct Bank<'a> {
    memory: &'a BlackBoxMemory,
    index: usize,
    layout: u8,
}

impl<'a> Bank<'a> {
    /// Bank 0 or 1.
    pub const fn new(memory: &'a BlackBoxMemory, index: usize) -> Self {
        Self::of_layout(memory, index, LAYOUT_VERSION)
    }

    /// A bank with one of the [`LAYOUTS`](super::LAYOUTS).
    pub const fn of_layout(memory: &'a BlackBoxMemory, index: usize, layout: u8) -> Self {
        Self {
            memory,
            index,
            layout,
        }
    }

    /// The event it holds, if any.
    pub fn event(&self) -> Option<Event> {
        self.header().event()
    }

    /// Its samples, in no order.
    pub fn samples(&self) -> impl Iterator<Item = BlackBoxSample> + 'a {
        let Self { memory, index, .. } = *self;
        let number = self.header().number();
        (0..SAMPLES_A_BANK).filter_map(move |slot| {
            let record = read(memory, index, slot);
            BlackBoxSample::from_record(&record, number?)
        })
    }

    /// The samples of a bank of layout 1, in no order.
    pub fn first_samples(&self) -> impl Iterator<Item = BlackBoxSample> + 'a {
        let Self { memory, index, .. } = *self;
        let number = self.header().number();
        (0..FIRST_SAMPLES).filter_map(move |slot| {
            let mut record = [0; FIRST_RECORD_WORDS];
            let first = slot.saturating_mul(FIRST_RECORD_WORDS);
            memory.read(index, first.saturating_add(HEADER_WORDS), &mut record);
            BlackBoxSample::from_first_record(&record, number?)
        })
    }

    /// The last sample.
    #[inline(never)]
    pub(super) fn newest(&self) -> Option<BlackBoxSample> {
        self.samples().max_by_key(|sample| sample.time)
    }

    pub(super) const fn header(&self) -> Header<'a> {
        Header {
            memory: self.memory,
            bank: self.index,
            layout: self.layout,
        }
    }
}

/// Writes the samples of one recording.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rings {
    number: u16,
    /// Samples written.
    count: u32,
    /// The slots to write next.
    fine: usize,
    coarse: usize,
}

impl Rings {
    pub const fn new(number: u16) -> Self {
        Self {
            number,
            count: 0,
            fine: 0,
            coarse: 0,
        }
    }

    #[inline(never)]
    pub fn push(&mut self, memory: &BlackBoxMemory, bank: usize, sample: &BlackBoxSample) {
        let overwrites = self.count as usize >= FINE;
        if overwrites && self.count.is_multiple_of(THINNING) {
            let old = read(memory, bank, self.fine);
            write(memory, bank, FINE.saturating_add(self.coarse), &old);
            self.coarse = next(self.coarse, COARSE);
        }
        write(memory, bank, self.fine, &sample.record(self.number));
        self.fine = next(self.fine, FINE);
        self.count = self.count.saturating_add(1);
    }
}

fn next(slot: usize, length: usize) -> usize {
    let next = slot.saturating_add(1);
    if next == length { 0 } else { next }
}

fn first_word(slot: usize) -> usize {
    slot.saturating_mul(RECORD_WORDS)
        .saturating_add(HEADER_WORDS)
}

fn read(memory: &BlackBoxMemory, bank: usize, slot: usize) -> Record {
    let mut record = [0; RECORD_WORDS];
    memory.read(bank, first_word(slot), &mut record);
    record
}

fn write(memory: &BlackBoxMemory, bank: usize, slot: usize, record: &Record) {
    memory.write(bank, first_word(slot), record);
}
