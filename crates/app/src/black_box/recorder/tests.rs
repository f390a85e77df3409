use super::*;
use crate::{
    black_box::{CommandSource, SAMPLES_A_BANK},
    domain::{DriveMode, LogicBus, OperatorState},
    safety::{ArmingState, DriveEnd, SafetyFlags},
};

/// Samples of a second.
const SECOND: u64 = 100;

struct Bench {
    memory: &'static BlackBoxMemory,
    black_box: BlackBox,
    report: DiagnosticsSnapshot,
}

impl Bench {
    fn new() -> Self {
        Self::after(
            Box::leak(Box::default()),
            ResetCause::PowerOn,
            CrashCause::Silent,
        )
    }

    fn after(memory: &'static BlackBoxMemory, reset: ResetCause, crash: CrashCause) -> Self {
        let mut report = DiagnosticsSnapshot {
            ts_us: 1_000_000,
            ..DiagnosticsSnapshot::default()
        };
        report.safety.flags = SafetyFlags::NONE;
        Self {
            memory,
            black_box: BlackBox::boot(memory, reset, crash),
            report,
        }
    }

    /// The chip is reset and boots.
    fn reset(&mut self, reset: ResetCause, crash: CrashCause) {
        *self = Self::after(self.memory, reset, crash);
    }

    fn run(&mut self, samples: u64) {
        for _ in 0..samples {
            self.report.ts_us += 10_000;
            self.black_box
                .step(&self.report, &WheelOdomConfig::default());
        }
    }

    fn arm(&mut self) {
        self.report.arming.state = ArmingState::Armed;
        self.run(1);
    }

    fn disarm(&mut self, blockers: ArmingBlockers, flags: SafetyFlags) {
        self.report.arming.state = ArmingState::Disarmed;
        self.report.drive_end = DriveEnd { blockers, flags };
        self.run(1);
    }

    fn fall(&mut self) {
        self.disarm(ArmingBlockers::SAFETY_STOP, SafetyFlags::TILT);
    }

    fn states(&self) -> [BankState; 2] {
        self.black_box.status.banks.map(|bank| bank.state)
    }

    fn event(&self, bank: usize) -> Option<Event> {
        Bank::new(self.memory, bank).event()
    }

    fn times(&self, bank: usize) -> Vec<u32> {
        let samples = Bank::new(self.memory, bank).samples();
        let mut times: Vec<u32> = samples.map(|sample| sample.time).collect();
        times.sort_unstable();
        times
    }
}

#[test]
fn a_fall_is_kept_with_the_seconds_before_and_after() {
    let mut bench = Bench::new();
    bench.run(10 * SECOND);
    bench.arm();
    bench.run(10 * SECOND);
    bench.fall();
    let fell = (bench.report.ts_us / 100) as u32;
    assert_eq!(bench.states(), [BankState::Closing, BankState::Empty]);
    bench.run(20 * SECOND);
    assert_eq!(bench.states(), [BankState::Event, BankState::Recording]);
    let event = bench.event(0).expect("an event");
    assert_eq!((event.kind, event.time), (EventKind::Stop, fell));
    assert_eq!(event.flags, SafetyFlags::TILT);
    assert_eq!(event.reset, None);
    let times = bench.times(0);
    assert_eq!(times.len(), SAMPLES_A_BANK);
    // 0.7 s after, 0.8 s before at 100 Hz, and 3.4 s before that at 20 Hz.
    assert_eq!(times.last(), Some(&(fell + 7_000)));
    let gaps: Vec<u32> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    assert!(gaps[..67].iter().all(|gap| *gap == 500), "{gaps:?}");
    assert!(gaps[68..].iter().all(|gap| *gap == 100), "{gaps:?}");
    assert!(gaps[67] <= 500);
    assert!(fell - times[0] >= 42_000 && fell - times[68] >= 8_400);
}

#[test]
fn what_the_pilot_asks_for_is_no_event() {
    for (blockers, flags) in [
        (ArmingBlockers::ENABLE_OFF, SafetyFlags::NONE),
        (ArmingBlockers::SAFETY_STOP, SafetyFlags::E_STOP),
        (
            ArmingBlockers::SAFETY_STOP.union(ArmingBlockers::ENABLE_OFF),
            SafetyFlags::E_STOP.union(SafetyFlags::BATTERY_LOW),
        ),
        (ArmingBlockers::BRING_UP_READ_ONLY, SafetyFlags::NONE),
    ] {
        let mut bench = Bench::new();
        bench.arm();
        bench.run(SECOND);
        bench.disarm(blockers, flags);
        bench.run(SECOND);
        assert_eq!(bench.states(), [BankState::Recording, BankState::Empty]);
        assert_eq!(bench.event(0), None);
    }
}

#[test]
fn every_other_end_of_a_drive_is_an_event() {
    for (blockers, flags) in [
        (ArmingBlockers::REMOTE_NOT_FRESH, SafetyFlags::NONE),
        (ArmingBlockers::ESTIMATE_INVALID, SafetyFlags::NONE),
        (ArmingBlockers::SAFETY_STOP, SafetyFlags::REMOTE_LOST),
        (ArmingBlockers::SAFETY_STOP, SafetyFlags::TASK_LATE),
        (
            ArmingBlockers::SAFETY_STOP.union(ArmingBlockers::ENABLE_OFF),
            SafetyFlags::E_STOP.union(SafetyFlags::REMOTE_FAILSAFE),
        ),
    ] {
        let mut bench = Bench::new();
        bench.arm();
        bench.disarm(blockers, flags);
        bench.run(SECOND);
        let event = bench.event(0).expect("an event");
        assert_eq!((event.blockers, event.flags), (blockers, flags));
    }
}

#[test]
fn a_partial_stop_counts_once_a_drive() {
    let mut bench = Bench::new();
    bench.report.safety.flags = SafetyFlags::WHEEL_HOT;
    bench.arm();
    bench.run(SECOND);
    assert_eq!(bench.event(0), None, "it was there before");
    for _ in 0..5 {
        bench.report.safety.flags = SafetyFlags::CAN1_FAULT;
        bench.run(SECOND);
        bench.report.safety.flags = SafetyFlags::STICKS_AWAITED;
        bench.run(SECOND);
    }
    let event = bench.event(0).expect("an event");
    assert_eq!(event.kind, EventKind::PartialStop);
    assert_eq!(event.flags, SafetyFlags::CAN1_FAULT);
    assert_eq!(bench.states(), [BankState::Event, BankState::Recording]);
    bench.report.safety.flags = SafetyFlags::JOINT_SILENT;
    bench.run(SECOND);
    let event = bench.event(1).expect("another event");
    assert_eq!(event.flags, SafetyFlags::JOINT_SILENT);
}

/// Mode PC without a PC is no event; a PC that steered and falls silent is.
#[test]
fn only_a_pc_that_steered_can_be_lost() {
    let mut bench = Bench::new();
    bench.arm();
    bench.report.operator.mode = DriveMode::Pc;
    bench.report.logic.pc_selected = true;
    for flags in [SafetyFlags::PC_LOST, SafetyFlags::PC_AWAITED] {
        bench.report.safety.flags = flags;
        bench.run(SECOND);
    }
    bench.report.safety.flags = SafetyFlags::PC_LOST;
    bench.run(SECOND);
    assert_eq!(bench.event(0), None);
    bench.report.safety.flags = SafetyFlags::NONE;
    bench.run(SECOND);
    bench.report.safety.flags = SafetyFlags::PC_LOST;
    bench.run(SECOND);
    let event = bench.event(0).expect("an event");
    assert_eq!(event.kind, EventKind::PartialStop);
    assert_eq!(event.flags, SafetyFlags::PC_LOST);
}

/// A gap of 105 ms can begin and end between two reports. What remains is that the PC must begin from rest.
#[test]
fn a_loss_of_the_pc_too_short_to_be_seen_counts_too() {
    let mut bench = steered_by_a_pc();
    bench.report.safety.flags = SafetyFlags::PC_AWAITED;
    bench.run(SECOND);
    let event = bench.event(0).expect("an event");
    assert_eq!(event.kind, EventKind::PartialStop);
    assert_eq!(event.flags, SafetyFlags::PC_AWAITED);
}

/// The robot is armed before the PC's program runs.
#[test]
fn a_pc_that_was_missing_when_the_robot_was_armed_can_be_lost_later() {
    for flags in [SafetyFlags::PC_LOST, SafetyFlags::PC_AWAITED] {
        let mut bench = Bench::new();
        bench.report.operator.mode = DriveMode::Pc;
        bench.report.logic.pc_selected = true;
        bench.report.safety.flags = flags;
        bench.arm();
        bench.run(SECOND);
        bench.report.safety.flags = SafetyFlags::NONE;
        bench.run(SECOND);
        assert_eq!(bench.event(0), None);
        bench.report.safety.flags = flags;
        bench.run(SECOND);
        assert_eq!(bench.event(0).expect("an event").flags, flags);
    }
}

#[test]
fn a_pc_that_the_pilot_lets_go_is_not_lost() {
    let mut bench = steered_by_a_pc();
    for selected in [false, true] {
        bench.report.logic.pc_selected = selected;
        bench.report.safety.flags = SafetyFlags::PC_AWAITED;
        bench.run(SECOND);
    }
    assert_eq!(bench.event(0), None);
}

/// The PC must begin from rest after any stop. That is no event of its own.
#[test]
fn what_follows_from_another_stop_is_not_the_pcs() {
    let mut bench = Bench::new();
    bench.report.safety.flags = SafetyFlags::WHEEL_HOT;
    bench.arm();
    bench.report.operator.mode = DriveMode::Pc;
    bench.report.logic.pc_selected = true;
    bench.run(SECOND);
    bench.report.safety.flags = SafetyFlags::PC_AWAITED;
    bench.run(SECOND);
    assert_eq!(bench.event(0), None, "a motor cooled down");
    let mut bench = steered_by_a_pc();
    bench.report.safety.flags = SafetyFlags::COMMAND_STALE.union(SafetyFlags::PC_AWAITED);
    bench.run(SECOND);
    let event = bench.event(0).expect("an event");
    assert_eq!(event.flags, SafetyFlags::COMMAND_STALE);
}

/// A bad cable: the first loss is kept, the gaps after it do not overwrite it.
#[test]
fn a_gap_after_a_loss_is_no_other_event() {
    let mut bench = steered_by_a_pc();
    for flags in [SafetyFlags::PC_LOST, SafetyFlags::PC_AWAITED] {
        bench.report.safety.flags = flags;
        bench.run(SECOND);
        bench.report.safety.flags = SafetyFlags::NONE;
        bench.run(SECOND);
    }
    assert_eq!(bench.states(), [BankState::Event, BankState::Recording]);
}

fn steered_by_a_pc() -> Bench {
    let mut bench = Bench::new();
    bench.arm();
    bench.report.operator.mode = DriveMode::Pc;
    bench.report.logic.pc_selected = true;
    bench.run(SECOND);
    bench
}

/// Only what remains of a stop that began and ended between two reports.
#[test]
fn a_partial_stop_too_short_to_be_seen_counts_too() {
    let mut bench = Bench::new();
    bench.arm();
    bench.report.safety.flags = SafetyFlags::STICKS_AWAITED;
    bench.run(SECOND);
    let event = bench.event(0).expect("an event");
    assert_eq!(event.flags, SafetyFlags::STICKS_AWAITED);
}

#[test]
fn the_newest_event_is_kept_and_the_older_one_only_until_the_robot_is_armed() {
    let mut bench = Bench::new();
    for _ in 0..2 {
        bench.arm();
        bench.run(SECOND);
        bench.fall();
        bench.run(SECOND);
    }
    assert_eq!(bench.states(), [BankState::Event; 2]);
    let second = bench.event(1);
    bench.run(SECOND);
    assert_eq!(bench.states(), [BankState::Event; 2], "disarmed");
    bench.arm();
    assert_eq!(bench.states(), [BankState::Recording, BankState::Event]);
    assert_eq!(bench.black_box.status.overwritten, 1);
    assert_eq!(bench.event(1), second);
    bench.fall();
    bench.run(SECOND);
    bench.arm();
    assert_eq!(bench.states(), [BankState::Event, BankState::Recording]);
    assert_eq!(bench.black_box.status.overwritten, 2);
}

/// The drive ends in the very sample after an event is complete.
#[test]
fn an_event_right_after_another_is_kept() {
    let mut bench = Bench::new();
    bench.arm();
    bench.fall();
    bench.run(SECOND);
    bench.arm();
    bench.report.safety.flags = SafetyFlags::CAN2_FAULT;
    bench.run(u64::from(AFTER) + 1);
    assert_eq!(bench.states(), [BankState::Recording, BankState::Event]);
    bench.fall();
    assert_eq!(bench.states()[0], BankState::Closing);
}

#[test]
fn only_the_released_event_goes() {
    let mut bench = Bench::new();
    bench.arm();
    bench.fall();
    bench.run(SECOND);
    let number = bench.event(0).expect("an event").number;
    bench.report.tuning.black_box_released = [number + 1, number];
    bench.run(1);
    assert!(bench.event(0).is_some());
    bench.report.tuning.black_box_released = [number, 0];
    bench.run(1);
    assert_eq!(bench.event(0), None);
    assert_eq!(bench.states(), [BankState::Empty, BankState::Recording]);
    bench.reset(ResetCause::Pin, CrashCause::Silent);
    assert_eq!(bench.states(), [BankState::Empty; 2]);
}

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
    for word in 16..32 {
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
        for at in 0..super::super::memory::BANK_WORDS {
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

#[test]
fn numbers_wrap_past_zero() {
    assert!(is_newer(1, u16::MAX) && !is_newer(u16::MAX, 1));
    let mut bench = Bench::new();
    bench.black_box.last_number = u16::MAX;
    bench.run(1);
    assert_eq!(bench.black_box.status.banks[0].number, 1);
}

#[test]
fn a_sample_of_the_report_has_the_robots_directions() {
    let mut report = DiagnosticsSnapshot {
        ts_us: 2_000_000,
        operator: OperatorState {
            enabled: true,
            ..OperatorState::default()
        },
        logic: LogicBus {
            hl_valid: true,
            ts_us: 1_988_000,
            ..LogicBus::default()
        },
        ..DiagnosticsSnapshot::default()
    };
    for (wheel, rpm) in report.sensors.motor.wheels.iter_mut().zip([1_000, -1_000]) {
        wheel.rpm = rpm;
        wheel.current_ma = f32::from(rpm);
    }
    let sample = BlackBoxSample::of(&report, &WheelOdomConfig::default());
    // 1000 / (3591 / 187) turns a minute.
    let speed = 1_000.0 * 187.0 / 3_591.0 / 60.0 * core::f32::consts::TAU;
    assert!((sample.wheel_rps[0] - speed).abs() < 1e-3);
    assert_eq!(sample.wheel_rps[0], sample.wheel_rps[1]);
    assert_eq!(sample.measured_ma, [1_000.0; 2]);
    assert_eq!(sample.command_age_ms, 12);
    assert_eq!(sample.radio_age_ms, 0);
    assert!(sample.enabled && !sample.armed);
    // The PC's command is younger than the link's state says.
    report.operator.mode = DriveMode::Pc;
    (report.logic.hl_valid, report.logic.pc_selected) = (false, true);
    (report.link.last_us, report.pc_age_us) = (1_975_000, 5_900);
    let sample = BlackBoxSample::of(&report, &WheelOdomConfig::default());
    assert_eq!(sample.source, CommandSource::Pc);
    assert_eq!(sample.command_age_ms, 5);
}
