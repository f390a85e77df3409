//! What a reset leaves in memory, whole or damaged.

use super::*;
use crate::black_box::memory::BANK_WORDS;

#[test]
fn a_reset_that_nobody_asked_for_ends_a_recording_as_an_event() {
    let mut bench = Bench::new();
    bench.arm();
    bench.run(6 * SECOND);
    let last = (bench.report.ts_us / 100) as u32;
    bench.reset(ResetCause::IndependentWatchdog, CrashCause::Panic);
    assert_eq!(bench.states(), [BankState::Event, BankState::Empty]);
    let event = bench.event(0).expect("an event");
    assert_eq!((event.kind, event.time), (EventKind::Reset, last));
    let cause = (ResetCause::IndependentWatchdog, CrashCause::Panic);
    assert_eq!(event.reset, Some(cause));
    assert_eq!(bench.times(0).len(), SAMPLES_A_BANK);
    // It survives the next resets, and the next recording is another one.
    bench.run(SECOND);
    bench.reset(ResetCause::Pin, CrashCause::Silent);
    assert_eq!(bench.event(0), Some(event));
    bench.run(1);
    assert_eq!(bench.states(), [BankState::Event, BankState::Recording]);
    assert!(bench.black_box.status.banks[1].number > event.number);
}

#[test]
fn a_reset_while_disarmed_counts_only_if_the_program_failed() {
    for (reset, crash, counts) in [
        (ResetCause::Pin, CrashCause::Silent, false),
        (ResetCause::Software, CrashCause::Silent, false),
        (ResetCause::Software, CrashCause::HardFault, true),
        (ResetCause::IndependentWatchdog, CrashCause::Silent, true),
    ] {
        let mut bench = Bench::new();
        bench.run(SECOND);
        bench.reset(reset, crash);
        assert_eq!(bench.event(0).is_some(), counts, "{reset:?}");
        let mut bench = Bench::new();
        bench.arm();
        bench.reset(reset, crash);
        assert!(bench.event(0).is_some(), "{reset:?} while armed");
    }
}

#[test]
fn a_reset_soon_after_a_stop_is_noted_in_its_event() {
    let mut bench = Bench::new();
    bench.arm();
    bench.disarm(ArmingBlockers::SAFETY_STOP, SafetyFlags::TASK_LATE);
    bench.run(3);
    bench.reset(ResetCause::IndependentWatchdog, CrashCause::ImuLate);
    let event = bench.event(0).expect("an event");
    assert_eq!(event.kind, EventKind::Stop);
    let cause = (ResetCause::IndependentWatchdog, CrashCause::ImuLate);
    assert_eq!(event.reset, Some(cause));
    // A later reset is not this event's.
    bench.reset(ResetCause::Pin, CrashCause::Silent);
    assert_eq!(bench.event(0), Some(event));
}

#[test]
fn a_power_on_empties_it() {
    let mut bench = Bench::new();
    bench.arm();
    bench.fall();
    bench.run(SECOND);
    bench.reset(ResetCause::PowerOn, CrashCause::Silent);
    assert_eq!(bench.states(), [BankState::Empty; 2]);
    assert_eq!(bench.event(0), None);
}

/// RAM may keep its content over a short loss of power. Numbers then begin anew, so the old records must be gone.
#[test]
fn nothing_of_an_older_run_shows_in_a_recording_of_the_same_number() {
    let mut bench = Bench::new();
    bench.arm();
    bench.run(60 * SECOND);
    bench.reset(ResetCause::PowerOn, CrashCause::Silent);
    bench.run(SECOND);
    bench.reset(ResetCause::Pin, CrashCause::Silent);
    assert_eq!(bench.event(0), None);
    // Nor after a reset that is no event.
    bench.run(60 * SECOND);
    bench.reset(ResetCause::Pin, CrashCause::Silent);
    bench.arm();
    bench.run(SECOND);
    let last = (bench.report.ts_us / 100) as u32;
    bench.reset(ResetCause::IndependentWatchdog, CrashCause::Panic);
    assert_eq!(bench.event(0).expect("an event").time, last);
    assert_eq!(bench.times(0).len(), SECOND as usize + 1);
}

/// Every word of the header damaged in turn: the event is whole, or loses what its damaged part held, or is gone.
#[test]
fn a_damaged_header_shows_nothing_wrong() {
    let mut bench = Bench::new();
    bench.arm();
    bench.run(SECOND);
    bench.fall();
    bench.run(SECOND);
    let whole = bench.event(0).expect("an event");
    for word in 0..16 {
        for bit in 0..32 {
            let value = bench.memory.word(0, word);
            bench.memory.write(0, word, &[value ^ 1 << bit]);
            let found = bench.event(0);
            assert!(found.is_none() || found == Some(whole), "{word} {bit}");
            assert_eq!(found.is_some(), word > 8, "{word} {bit}");
            bench.memory.write(0, word, &[value]);
        }
    }
}

#[test]
fn a_damaged_record_is_left_out() {
    let mut bench = Bench::new();
    bench.arm();
    bench.run(50);
    bench.fall();
    bench.run(SECOND);
    let whole = bench.times(0).len();
    for word in 16..34 {
        let value = bench.memory.word(0, word);
        bench.memory.write(0, word, &[value ^ 0x8000]);
        assert_eq!(bench.times(0).len(), whole - 1);
        bench.memory.write(0, word, &[value]);
    }
}

#[test]
fn memory_full_of_noise_holds_nothing() {
    let memory: &'static BlackBoxMemory = Box::leak(Box::default());
    let mut noise = 1_u32;
    for bank in 0..BANK_COUNT {
        for at in 0..BANK_WORDS {
            noise = noise.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            memory.write(bank, at, &[noise]);
        }
    }
    let bench = Bench::after(memory, ResetCause::IndependentWatchdog, CrashCause::Panic);
    assert_eq!(bench.states(), [BankState::Empty; 2]);
}

/// A recording in a bank that held another: the old records in it are not taken for its own.
#[test]
fn records_of_an_older_recording_do_not_count() {
    let mut bench = Bench::new();
    bench.run(10 * SECOND);
    bench.arm();
    bench.fall();
    bench.run(SECOND);
    let number = bench.event(0).expect("an event").number;
    bench.report.tuning.black_box_released = [number, 0];
    bench.run(1);
    bench.arm();
    bench.fall();
    bench.run(SECOND);
    bench.run(1);
    bench.arm();
    bench.run(5);
    assert_eq!(bench.black_box.status.banks[0].state, BankState::Recording);
    assert!(bench.times(0).len() < 50, "{}", bench.times(0).len());
}
