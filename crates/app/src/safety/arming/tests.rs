use super::*;
use crate::domain::{JointState, MotorFeedback, RobotConfig};

struct Bench {
    arming: Arming,
    config: SafetyConfig,
    now_us: u64,
    enabled: bool,
    disabled: bool,
    calibrated: bool,
    read_only: bool,
    tries_motors: bool,
    flash_busy: bool,
    params: ParamStatus,
    debugger_catches: bool,
    joint_timeout_unset: bool,
    sticks_rest: bool,
    estimate_valid: bool,
    attitude_settled: bool,
    remote_age_us: u32,
    motor: MotorFeedback,
    safety: SafetyStatus,
}

impl Bench {
    fn new() -> Self {
        let mut motor = MotorFeedback::default();
        for joint in &mut motor.joints {
            joint.state = JointState::Disabled;
            joint.ts_us = 1;
        }
        for wheel in &mut motor.wheels {
            wheel.ts_us = 1;
        }
        Self {
            arming: Arming::default(),
            config: SafetyConfig::default(),
            now_us: 1_000_000,
            enabled: false,
            disabled: true,
            calibrated: true,
            read_only: false,
            tries_motors: false,
            flash_busy: false,
            params: ParamStatus::default(),
            debugger_catches: false,
            joint_timeout_unset: false,
            sticks_rest: true,
            estimate_valid: true,
            attitude_settled: true,
            remote_age_us: 5_000,
            motor,
            safety: SafetyStatus::of(SafetyFlags::NONE),
        }
    }

    fn flip_on(&mut self) {
        (self.enabled, self.disabled) = (true, false);
    }

    fn flip_off(&mut self) {
        (self.enabled, self.disabled) = (false, true);
    }

    fn run(&mut self, milliseconds: u64) -> ArmingStatus {
        let mut status = ArmingStatus::default();
        for _ in 0..milliseconds {
            self.now_us += 1_000;
            let inputs = ArmingInputs {
                config: &self.config,
                sticks_rest: self.sticks_rest,
                remote_age_us: self.remote_age_us,
                operator: &OperatorState {
                    enabled: self.enabled,
                    disabled: self.disabled,
                    e_stop: false,
                    ts_us: self.now_us,
                    ..OperatorState::default()
                },
                estimate_valid: self.estimate_valid,
                attitude_settled: self.attitude_settled,
                calibrated: self.calibrated,
                motor: &MotorFindings::of(&self.motor, &RobotConfig::default().joints),
                read_only: self.read_only,
                tries_motors: self.tries_motors,
                flash_busy: self.flash_busy,
                params: &self.params,
                debugger_catches: self.debugger_catches,
                joint_timeout_unset: self.joint_timeout_unset,
                safety: &self.safety,
            };
            let (now, token) = self.arming.step(&inputs, self.now_us);
            assert_eq!(token.is_some(), now.state == ArmingState::Armed);
            status = now;
        }
        status
    }
}

#[test]
fn off_then_on_arms_at_once() {
    let mut bench = Bench::new();
    assert_eq!(bench.run(1).blockers, ArmingBlockers::ENABLE_OFF);
    bench.flip_on();
    assert_eq!(bench.run(1).state, ArmingState::Armed);
}

/// Flips the switch with one thing wrong, then mends it.
fn refused_by(spoil: impl Fn(&mut Bench), mend: impl Fn(&mut Bench), blocker: ArmingBlockers) {
    let mut bench = Bench::new();
    spoil(&mut bench);
    bench.run(1);
    bench.flip_on();
    let status = bench.run(1);
    assert!(status.blockers.contains(blocker), "{:?}", status.blockers);
    assert!(status.blockers.contains(ArmingBlockers::ENABLE_NOT_CYCLED));
    assert!(status.refused.contains(blocker), "{:?}", status.refused);
    mend(&mut bench);
    let later = bench.run(5_000);
    assert_eq!(later.blockers, ArmingBlockers::ENABLE_NOT_CYCLED);
    assert_eq!(later.refused, status.refused);
    bench.flip_off();
    bench.run(1);
    bench.flip_on();
    let armed = bench.run(1);
    assert_eq!(armed.state, ArmingState::Armed);
    assert_eq!(armed.refused, ArmingBlockers::NONE);
}

#[test]
fn a_refused_request_is_used_up() {
    use ArmingBlockers as B;
    refused_by(
        |b| b.calibrated = false,
        |b| b.calibrated = true,
        B::CALIBRATION_PENDING,
    );
    refused_by(
        |b| b.sticks_rest = false,
        |b| b.sticks_rest = true,
        B::STICKS_NOT_CENTRED,
    );
    refused_by(
        |b| b.estimate_valid = false,
        |b| b.estimate_valid = true,
        B::ESTIMATE_INVALID,
    );
    refused_by(
        |b| b.read_only = true,
        |b| b.read_only = false,
        B::BRING_UP_READ_ONLY,
    );
    refused_by(
        |b| b.safety = SafetyStatus::of(SafetyFlags::CAN1_CONGESTED),
        |b| b.safety = SafetyStatus::of(SafetyFlags::NONE),
        B::SAFETY_STOP,
    );
    // Motors that get their power later.
    refused_by(
        |b| b.motor.joints[2].state = JointState::Silent,
        |b| b.motor.joints[2].state = JointState::Disabled,
        B::JOINTS_NOT_READY,
    );
    refused_by(
        |b| b.motor.wheels[1].ts_us = 0,
        |b| b.motor.wheels[1].ts_us = 1,
        B::WHEEL_NEVER_HEARD,
    );
}

/// Settings may give another channel to the enable switch, one that is on.
#[test]
fn a_switch_that_is_on_when_settings_change_must_be_seen_off_first() {
    let mut bench = Bench::new();
    bench.run(10);
    bench.arming.settings_changed(bench.now_us);
    // Frames from before the change still say off.
    bench.run(4);
    bench.flip_on();
    assert_eq!(bench.run(10).blockers, ArmingBlockers::ENABLE_NOT_CYCLED);
    bench.flip_off();
    bench.run(1);
    bench.flip_on();
    assert_eq!(bench.run(1).state, ArmingState::Armed);
}

/// Blockers when the switch is flipped with this one thing wrong, and whether the robot stays armed when it goes
/// wrong later.
fn with_wrong(spoil: impl Fn(&mut Bench)) -> (ArmingBlockers, ArmingState) {
    let mut before = Bench::new();
    before.run(1);
    before.flip_on();
    spoil(&mut before);
    let status = before.run(1);
    assert_eq!(
        status.waiting,
        status.refused.is_empty() && !status.blockers.is_empty()
    );
    let blockers = if status.waiting {
        status.blockers
    } else {
        status.refused
    };

    let mut later = Bench::new();
    later.run(1);
    later.flip_on();
    assert_eq!(later.run(1).state, ArmingState::Armed);
    spoil(&mut later);
    (blockers, later.run(10).state)
}

#[test]
fn stops_of_a_part_forbid_arming_but_do_not_disarm() {
    let flags = [
        SafetyFlags::CAN1_FAULT,
        SafetyFlags::CAN2_CONGESTED,
        SafetyFlags::WHEEL_HOT,
        SafetyFlags::JOINT_HOT,
        SafetyFlags::JOINT_FROZEN,
    ];
    for flag in flags {
        let result = with_wrong(|bench| bench.safety = SafetyStatus::of(flag));
        assert_eq!(result, (ArmingBlockers::SAFETY_STOP, ArmingState::Armed));
    }
}

#[test]
fn global_stops_disarm() {
    for flag in [
        SafetyFlags::E_STOP,
        SafetyFlags::TILT,
        SafetyFlags::BATTERY_EMPTY,
    ] {
        let result = with_wrong(|bench| bench.safety = SafetyStatus::of(flag));
        assert_eq!(result, (ArmingBlockers::SAFETY_STOP, ArmingState::Disarmed));
    }
}

#[test]
fn a_low_battery_forbids_arming_but_does_not_disarm() {
    let result = with_wrong(|bench| bench.safety = SafetyStatus::of(SafetyFlags::BATTERY_LOW));
    assert_eq!(result, (ArmingBlockers::BATTERY_LOW, ArmingState::Armed));
}

#[test]
fn every_joint_must_be_set_up_and_without_a_fault() {
    for joint in 0..4 {
        for state in [JointState::Silent, JointState::SettingUp, JointState::Fault] {
            let result = with_wrong(|bench| bench.motor.joints[joint].state = state);
            assert_eq!(
                result,
                (ArmingBlockers::JOINTS_NOT_READY, ArmingState::Armed)
            );
        }
        for state in [JointState::Enabling, JointState::Enabled] {
            let result = with_wrong(|bench| bench.motor.joints[joint].state = state);
            assert_eq!(result, (ArmingBlockers::NONE, ArmingState::Armed));
        }
    }
}

#[test]
fn reading_only_forbids_arming_and_disarms() {
    let result = with_wrong(|bench| bench.read_only = true);
    assert_eq!(
        result,
        (ArmingBlockers::BRING_UP_READ_ONLY, ArmingState::Disarmed)
    );
}

/// A robot whose pilot has asked while flash was being written.
fn asked_while_flash_is_busy() -> Bench {
    let mut bench = Bench::new();
    bench.flash_busy = true;
    bench.run(1);
    bench.flip_on();
    bench
}

#[test]
fn a_flip_while_flash_is_busy_arms_when_it_is_done() {
    let result = with_wrong(|bench| bench.flash_busy = true);
    assert_eq!(result, (ArmingBlockers::FLASH_BUSY, ArmingState::Armed));
    let mut bench = asked_while_flash_is_busy();
    let status = bench.run(600);
    assert_eq!(status.blockers, ArmingBlockers::FLASH_BUSY);
    assert!(status.waiting);
    assert_eq!(status.refused, ArmingBlockers::NONE);
    bench.flash_busy = false;
    let status = bench.run(1);
    assert_eq!(status.state, ArmingState::Armed);
    assert!(!status.waiting);
}

/// Samples have a gap where the chip stood still.
#[test]
fn it_waits_for_the_attitude_that_settles_anew_after_an_erase() {
    let mut bench = asked_while_flash_is_busy();
    bench.run(10);
    bench.estimate_valid = false;
    bench.safety = SafetyStatus::of(SafetyFlags::ESTIMATE_INVALID.union(SafetyFlags::IMU_STALE));
    assert!(bench.run(100).waiting);
    bench.flash_busy = false;
    assert!(bench.run(500).waiting);
    bench.estimate_valid = true;
    bench.safety = SafetyStatus::of(SafetyFlags::NONE);
    assert_eq!(bench.run(1).state, ArmingState::Armed);
    // The next time there is nothing to wait for.
    bench.flip_off();
    bench.run(1);
    bench.estimate_valid = false;
    bench.flip_on();
    assert!(!bench.run(1).waiting);
}

#[test]
fn a_request_does_not_wait_for_ever() {
    for (waited_ms, waiting) in [(2_999, true), (3_002, false)] {
        let mut bench = asked_while_flash_is_busy();
        assert_eq!(bench.run(waited_ms).waiting, waiting);
    }
}

#[test]
fn a_waiting_request_is_refused_by_whatever_else_goes_wrong() {
    let spoils: [fn(&mut Bench); 7] = [
        |bench| bench.sticks_rest = false,
        |bench| bench.calibrated = false,
        |bench| bench.remote_age_us = 100_001,
        |bench| bench.read_only = true,
        |bench| bench.motor.joints[0].state = JointState::Fault,
        |bench| bench.safety = SafetyStatus::of(SafetyFlags::E_STOP),
        |bench| bench.safety = SafetyStatus::of(SafetyFlags::JOINT_SILENT),
    ];
    for spoil in spoils {
        let mut bench = asked_while_flash_is_busy();
        assert!(bench.run(10).waiting);
        spoil(&mut bench);
        assert!(!bench.run(1).waiting);
        bench.flash_busy = false;
        assert_eq!(bench.run(10).state, ArmingState::Disarmed);
    }
}

#[test]
fn wheels_that_are_not_what_they_should_be_forbid_arming_but_do_not_disarm() {
    for wheel in 0..2 {
        let result = with_wrong(|bench| bench.motor.wheels[wheel].ts_us = 0);
        assert_eq!(
            result,
            (ArmingBlockers::WHEEL_NEVER_HEARD, ArmingState::Armed)
        );
        let result = with_wrong(|bench| bench.motor.wheels[wheel].doubtful = true);
        assert_eq!(result, (ArmingBlockers::WHEEL_DOUBTFUL, ArmingState::Armed));
    }
}

#[test]
fn a_joint_beyond_its_limits_forbids_arming_but_does_not_disarm() {
    for joint in 0..4 {
        let result = with_wrong(|bench| bench.motor.joints[joint].pos_rad = -6.3);
        assert_eq!(
            result,
            (ArmingBlockers::JOINT_OUT_OF_LIMITS, ArmingState::Armed)
        );
    }
}

/// A new robot finds out which way its joints turn before their zeros are set.
#[test]
fn a_joint_beyond_its_limits_may_be_tried_out() {
    let result = with_wrong(|bench| {
        bench.motor.joints[1].pos_rad = 6.3;
        bench.tries_motors = true;
    });
    assert_eq!(result, (ArmingBlockers::NONE, ArmingState::Armed));
}

#[test]
fn refused_settings_forbid_arming() {
    let result = with_wrong(|bench| bench.params.refused = 1);
    let expected = (ArmingBlockers::SETTINGS_REFUSED, ArmingState::Armed);
    assert_eq!(result, expected);
}

#[test]
fn an_attitude_that_has_not_settled_forbids_arming_but_lets_no_robot_fall() {
    let result = with_wrong(|bench| bench.attitude_settled = false);
    let expected = (ArmingBlockers::ATTITUDE_UNSETTLED, ArmingState::Armed);
    assert_eq!(result, expected);
}

#[test]
fn a_debugger_that_catches_forbids_arming_but_lets_no_robot_fall() {
    let result = with_wrong(|bench| bench.debugger_catches = true);
    let expected = (ArmingBlockers::DEBUGGER_CATCHES, ArmingState::Armed);
    assert_eq!(result, expected);
}

#[test]
fn joint_motors_without_a_time_out_forbid_arming() {
    let result = with_wrong(|bench| bench.joint_timeout_unset = true);
    let expected = (ArmingBlockers::JOINT_TIMEOUT_UNSET, ArmingState::Armed);
    assert_eq!(result, expected);
}

#[test]
fn a_stick_that_does_not_rest_forbids_arming_but_does_not_disarm() {
    let result = with_wrong(|bench| bench.sticks_rest = false);
    let expected = (ArmingBlockers::STICKS_NOT_CENTRED, ArmingState::Armed);
    assert_eq!(result, expected);
}

#[test]
fn a_moment_of_doubt_disarms_and_is_no_flip_of_the_switch() {
    let mut bench = Bench::new();
    bench.run(1);
    bench.flip_on();
    assert_eq!(bench.run(1).state, ArmingState::Armed);
    bench.enabled = false;
    assert_eq!(bench.run(1).blockers, ArmingBlockers::ENABLE_OFF);
    bench.enabled = true;
    assert_eq!(bench.run(10).blockers, ArmingBlockers::ENABLE_NOT_CYCLED);
    (bench.enabled, bench.disabled) = (false, true);
    bench.run(1);
    bench.flip_on();
    assert_eq!(bench.run(1).state, ArmingState::Armed);
}

#[test]
fn each_blocker_has_a_bit_of_its_own_and_the_table_is_in_their_order() {
    let bits = BLOCKER_NAMES.map(|(blocker, _)| blocker.bits());
    assert!(bits.iter().all(|bits| bits.count_ones() == 1), "{bits:x?}");
    assert!(
        bits.is_sorted_by(|lower, higher| lower < higher),
        "{bits:x?}"
    );
    let both = ArmingBlockers::REMOTE_NOT_FRESH.union(ArmingBlockers::FLASH_BUSY);
    assert!(both.names().eq(["remote-not-fresh", "flash-busy"]));
}
