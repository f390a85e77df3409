//! The header of a bank, 16 words. Its parts are written one after the other, each with a checksum of its own, so that a
//! reset in between costs only the part that was being written.
//!
//! | words | hold | written |
//! |---|---|---|
//! | 0 to 3 | mark and version, number, time, CRC | when the recording begins |
//! | 4 to 8 | kind, time, safety flags, blockers, CRC | when an event happens |
//! | 9, 10 | reset cause and last words, CRC | at the boot after a reset, if that ended the recording |
//! | 11 | CRC | when the event is complete |
//!
//! The checksums of all parts take in the recording's number. Times are in 0.1 ms.

use super::{memory::BlackBoxMemory, sample::UNITS_A_SECOND};
use crate::{
    domain::{CrashCause, EventKind, ResetCause},
    math::checksum::checksum_of_words,
    safety::{ArmingBlockers, SafetyFlags},
};

/// Words of a header.
pub(super) const HEADER_WORDS: usize = 16;

const BEGUN_AT: usize = 0;
const EVENT_AT: usize = 4;
const RESET_AT: usize = 9;
const COMPLETE_AT: usize = 11;

/// An event as its header tells it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Event {
    /// Number of the recording.
    pub number: u16,
    /// What the event is about.
    pub kind: EventKind,
    /// Time in 0.1 ms since the boot of the recorded run. For a reset it is that of the last record.
    pub time: u32,
    /// The safety flags that caused it; for a reset those of the last record.
    pub flags: SafetyFlags,
    /// What disarmed the robot.
    pub blockers: ArmingBlockers,
    /// The reset that ended the recording, if one did, and what the run left in the crash record.
    pub reset: Option<(ResetCause, CrashCause)>,
}

impl Event {
    /// Its time in s since the boot of the recorded run.
    pub fn seconds(&self) -> f64 {
        f64::from(self.time) / UNITS_A_SECOND
    }
}

/// The header of one bank.
#[derive(Clone, Copy, Debug)]
pub(super) struct Header<'a> {
    pub memory: &'a BlackBoxMemory,
    pub bank: usize,
    pub layout: u8,
}

impl Header<'_> {
    /// Begins a recording. The parts of the last one end to count.
    pub fn begin(&self, number: u16, time: u32) {
        self.write(BEGUN_AT, [self.mark(), number.into(), time], number);
    }

    pub fn clear(&self) {
        self.memory.write(self.bank, 0, &[0; HEADER_WORDS]);
    }

    pub fn note_event(&self, event: &Event) {
        let part = [
            event.kind as u32,
            event.time,
            event.flags.bits(),
            event.blockers.bits(),
        ];
        self.write(EVENT_AT, part, event.number);
    }

    pub fn note_reset(&self, number: u16, cause: ResetCause, crash: CrashCause) {
        let part = [cause as u32 | u32::from(crash.code()) << 8];
        self.write(RESET_AT, part, number);
    }

    pub fn note_complete(&self, number: u16) {
        self.write(COMPLETE_AT, [], number);
    }

    /// Number of the recording; `None` if there is none.
    #[inline(never)]
    pub fn number(&self) -> Option<u16> {
        let number = self.word(BEGUN_AT.saturating_add(1)) as u16;
        let [mark, whole, _] = self.read(BEGUN_AT, number)?;
        (mark == self.mark() && whole == u32::from(number) && number != 0).then_some(number)
    }

    /// The event; `None` if none happened, or its part is damaged.
    #[inline(never)]
    pub fn event(&self) -> Option<Event> {
        let number = self.number()?;
        let [kind, time, flags, blockers] = self.read(EVENT_AT, number)?;
        let reset = self.read(RESET_AT, number).map(|[reset]| {
            let [cause, crash, ..] = reset.to_le_bytes();
            let cause = ResetCause::from_code(cause).unwrap_or_default();
            (cause, CrashCause::from_code(crash).unwrap_or_default())
        });
        Some(Event {
            number,
            kind: EventKind::from_code(kind as u8).unwrap_or_default(),
            time,
            flags: SafetyFlags::from_bits_retain(flags),
            blockers: ArmingBlockers::from_bits_retain(blockers),
            reset,
        })
    }

    pub fn is_complete(&self) -> bool {
        let complete = self
            .number()
            .and_then(|number| self.read::<0>(COMPLETE_AT, number));
        complete.is_some()
    }

    const fn mark(&self) -> u32 {
        u32::from_le_bytes([b'J', b'B', b'X', self.layout])
    }

    fn word(&self, at: usize) -> u32 {
        self.memory.word(self.bank, at)
    }

    fn write<const N: usize>(&self, at: usize, part: [u32; N], number: u16) {
        self.memory.write(self.bank, at, &part);
        let proof = proof(&part, at, number);
        self.memory.write(self.bank, at.saturating_add(N), &[proof]);
    }

    /// Returns `None` if the part's checksum is wrong.
    fn read<const N: usize>(&self, at: usize, number: u16) -> Option<[u32; N]> {
        let mut part = [0; N];
        self.memory.read(self.bank, at, &mut part);
        let found = self.word(at.saturating_add(N));
        (found == proof(&part, at, number)).then_some(part)
    }
}

fn proof(part: &[u32], at: usize, number: u16) -> u32 {
    let mut words = [0; HEADER_WORDS];
    let seed = u32::from(number) | (at as u32) << 16;
    for (word, value) in words.iter_mut().zip([seed].iter().chain(part)) {
        *word = *value;
    }
    checksum_of_words(&words)
}
