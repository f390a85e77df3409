mod pc;
mod resets;

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
    // 0.7 s after, 0.8 s before at 100 Hz, and 2.1 s before that at 20 Hz.
    assert_eq!(times.last(), Some(&(fell + 7_000)));
    let gaps: Vec<u32> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    assert!(gaps[..42].iter().all(|gap| *gap == 500), "{gaps:?}");
    assert!(gaps[43..].iter().all(|gap| *gap == 100), "{gaps:?}");
    assert!(gaps[42] <= 500);
    assert!(fell - times[0] >= 29_500 && fell - times[43] >= 8_400);
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
