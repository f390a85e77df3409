//! Records into the banks, and keeps events.

use super::{
    bank::{Bank, Rings},
    header::Event,
    memory::{BANK_COUNT, BlackBoxMemory},
    sample::BlackBoxSample,
    trigger::{StopWatch, Trigger},
};
use crate::{
    diagnostics::DiagnosticsSnapshot,
    domain::{
        BankState, BankStatus, BlackBoxStatus, CrashCause, EventKind, ResetCause, WheelOdomConfig,
    },
    safety::ArmingBlockers,
};

/// Samples recorded after an event.
const AFTER: u32 = 70;

/// The bank that records.
#[derive(Clone, Debug)]
struct Recording {
    bank: usize,
    rings: Rings,
    /// Samples until the event is complete; `None` before an event.
    closing: Option<u32>,
}

/// The recorder of the black box.
///
/// Two events are kept at most. An empty bank records at all times. If both hold events, one records only while the
/// robot is armed, and then in place of the older event: the newest is never overwritten.
#[derive(Debug)]
pub struct BlackBox {
    memory: &'static BlackBoxMemory,
    watch: StopWatch,
    recording: Option<Recording>,
    status: BlackBoxStatus,
    /// Number of the last recording begun.
    last_number: u16,
    /// Numbers of the events released last. Index = bank.
    released: [u16; BANK_COUNT],
}

impl BlackBox {
    /// Takes over what the run before left in memory. `reset` says why that run ended.
    ///
    /// A power-on empties the banks. After any other reset events stay, and a recording that the reset ended becomes an
    /// event, unless the robot was disarmed and the reset was asked for: by the reset pin, a debugger or the supply.
    pub fn boot(memory: &'static BlackBoxMemory, reset: ResetCause, crash: CrashCause) -> Self {
        let mut black_box = Self {
            memory,
            watch: StopWatch::default(),
            recording: None,
            status: BlackBoxStatus::default(),
            last_number: 0,
            released: [0; BANK_COUNT],
        };
        for index in 0..BANK_COUNT {
            black_box.take_over(index, reset, crash);
        }
        black_box
    }

    /// A bank without an event is erased whole. Numbers may begin anew now, and no record of an older recording may then
    /// count for one with the same number.
    #[inline(never)]
    fn take_over(&mut self, index: usize, reset: ResetCause, crash: CrashCause) {
        let bank = Bank::new(self.memory, index);
        let header = bank.header();
        let number = header.number();
        let (Some(number), true) = (number, reset != ResetCause::PowerOn) else {
            self.memory.erase(index);
            return;
        };
        let newest = bank.newest();
        if header.event().is_none()
            && let Some(last) = newest
            && (last.armed || !is_asked_for(reset, crash))
        {
            header.note_event(&Event {
                number,
                kind: EventKind::Reset,
                time: last.time,
                flags: last.flags,
                blockers: ArmingBlockers::NONE,
                reset: None,
            });
        }
        match header.event() {
            Some(event) if newest.is_some() => {
                if !header.is_complete() {
                    header.note_reset(number, reset, crash);
                    header.note_complete(number);
                }
                self.set_status(index, BankState::Event, event.kind, number);
                if is_newer(number, self.last_number) {
                    self.last_number = number;
                }
            }
            _ => self.memory.erase(index),
        }
    }

    /// Takes the next report, which must come every 10 ms.
    #[inline(never)]
    pub fn step(&mut self, report: &DiagnosticsSnapshot, wheels: &WheelOdomConfig) {
        self.release(&report.tuning.black_box_released);
        let sample = BlackBoxSample::of(report, wheels);
        let trigger = self.watch.step(report);
        if self.recording.is_none() {
            self.begin(&sample);
        }
        let Some(recording) = &mut self.recording else {
            return;
        };
        recording.rings.push(self.memory, recording.bank, &sample);
        match &mut recording.closing {
            None => {
                if let Some(trigger) = trigger {
                    self.note_event(&trigger, &sample);
                }
            }
            // What follows within this time belongs to the event; the records show it.
            Some(left) => {
                *left = left.saturating_sub(1);
                if *left == 0 {
                    self.complete();
                    self.begin(&sample);
                }
            }
        }
    }

    /// State for diagnostics and the tuning channel.
    pub const fn status(&self) -> &BlackBoxStatus {
        &self.status
    }

    /// Begins a recording where the rule allows one.
    #[inline(never)]
    fn begin(&mut self, sample: &BlackBoxSample) {
        let [first, second] = self.status.banks;
        let bank = match (first.state, second.state) {
            (BankState::Empty, _) => 0,
            (_, BankState::Empty) => 1,
            _ if !sample.armed => return,
            _ => {
                self.status.overwritten = self.status.overwritten.saturating_add(1);
                usize::from(is_newer(first.number, second.number))
            }
        };
        // 0 stands for none.
        let number = self.last_number.wrapping_add(1).max(1);
        self.last_number = number;
        let header = Bank::new(self.memory, bank).header();
        header.clear();
        header.begin(number, sample.time);
        self.recording = Some(Recording {
            bank,
            rings: Rings::new(number),
            closing: None,
        });
        self.set_status(bank, BankState::Recording, EventKind::None, number);
    }

    #[inline(never)]
    fn note_event(&mut self, trigger: &Trigger, sample: &BlackBoxSample) {
        let Some(recording) = &mut self.recording else {
            return;
        };
        recording.closing = Some(AFTER);
        let bank = recording.bank;
        let number = self.last_number;
        Bank::new(self.memory, bank).header().note_event(&Event {
            number,
            kind: trigger.kind,
            time: sample.time,
            flags: trigger.flags,
            blockers: trigger.blockers,
            reset: None,
        });
        self.set_status(bank, BankState::Closing, trigger.kind, number);
    }

    fn complete(&mut self) {
        let Some(Recording { bank, .. }) = self.recording.take() else {
            return;
        };
        let header = Bank::new(self.memory, bank).header();
        header.note_complete(self.last_number);
        let kind = self.status.banks.get(bank).map(|bank| bank.kind);
        self.set_status(
            bank,
            BankState::Event,
            kind.unwrap_or_default(),
            self.last_number,
        );
    }

    /// Empties the banks whose events have been released since the last call.
    fn release(&mut self, released: &[u16; BANK_COUNT]) {
        if self.released == *released {
            return;
        }
        self.released = *released;
        for (index, number) in released.iter().enumerate() {
            let status = self.status.banks.get(index).copied().unwrap_or_default();
            if status.state == BankState::Event && status.number == *number {
                Bank::new(self.memory, index).header().clear();
                self.set_status(index, BankState::Empty, EventKind::None, 0);
            }
        }
    }

    fn set_status(&mut self, bank: usize, state: BankState, kind: EventKind, number: u16) {
        if let Some(status) = self.status.banks.get_mut(bank) {
            *status = BankStatus {
                state,
                kind,
                number,
            };
        }
    }
}

/// Whether a person may have caused a reset on purpose.
fn is_asked_for(reset: ResetCause, crash: CrashCause) -> bool {
    let by_a_fault = matches!(
        reset,
        ResetCause::IndependentWatchdog | ResetCause::WindowWatchdog
    );
    !by_a_fault && crash == CrashCause::Silent
}

/// Whether recording `a` is younger than `b`, where numbers wrap.
fn is_newer(a: u16, b: u16) -> bool {
    a.wrapping_sub(b).cast_signed() > 0
}

#[cfg(test)]
mod tests;
