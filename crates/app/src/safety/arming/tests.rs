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
    tests_motors: bool,
    flash_busy: bool,
    params: ParamStatus,
    debugger_catches: bool,
    joint_timeout_unset: bool,
    sticks_centred: bool,
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
            tests_motors: false,
            flash_busy: false,
            params: ParamStatus::default(),
            debugger_catches: false,
            joint_timeout_unset: false,
            sticks_centred: true,
            estimate_valid: true,
            attitude_settled: true,
            remote_age_us: 5_000,
            motor,
            safety: SafetyStatus::from_flags(SafetyFlags::NONE),
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
                sticks_centred: self.sticks_centred,
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
                motor: &MotorReadiness::assess(&self.motor, &RobotConfig::default().joints),
                read_only: self.read_only,
                tests_motors: self.tests_motors,
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
fn switching_off_and_on_arms_at_once() {
    let mut bench = Bench::new();
    assert_eq!(bench.run(1).blockers, ArmingBlockers::ENABLE_OFF);
    bench.flip_on();
    assert_eq!(bench.run(1).state, ArmingState::Armed);
}

/// Flips the switch while one thing is wrong, then corrects it.
fn refused_by(inject: impl Fn(&mut Bench), correct: impl Fn(&mut Bench), blocker: ArmingBlockers) {
    let mut bench = Bench::new();
    inject(&mut bench);
    bench.run(1);
    bench.flip_on();
    let status = bench.run(1);
    assert!(status.blockers.contains(blocker), "{:?}", status.blockers);
    assert!(status.blockers.contains(ArmingBlockers::ENABLE_NOT_CYCLED));
    assert!(status.refused.contains(blocker), "{:?}", status.refused);
    correct(&mut bench);
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
fn a_refused_request_must_be_repeated() {
    use ArmingBlockers as B;
    refused_by(
        |b| b.calibrated = false,
        |b| b.calibrated = true,
        B::CALIBRATION_PENDING,
    );
    refused_by(
        |b| b.sticks_centred = false,
        |b| b.sticks_centred = true,
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
        |b| b.safety = SafetyStatus::from_flags(SafetyFlags::CAN1_CONGESTED),
        |b| b.safety = SafetyStatus::from_flags(SafetyFlags::NONE),
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

/// New settings may assign the enable switch to another channel, which is on.
#[test]
fn after_a_settings_change_the_switch_must_be_seen_off() {
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

/// Returns the blockers when the switch is flipped with this one fault, and whether the robot stays armed if the
/// fault occurs later.
fn with_wrong(inject: impl Fn(&mut Bench)) -> (ArmingBlockers, ArmingState) {
    let mut before = Bench::new();
    before.run(1);
    before.flip_on();
    inject(&mut before);
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
    inject(&mut later);
    (blockers, later.run(10).state)
}

#[test]
fn partial_stops_block_arming_but_do_not_disarm() {
    let flags = [
        SafetyFlags::CAN1_FAULT,
        SafetyFlags::CAN2_CONGESTED,
        SafetyFlags::WHEEL_HOT,
        SafetyFlags::JOINT_HOT,
        SafetyFlags::JOINT_FROZEN,
    ];
    for flag in flags {
        let result = with_wrong(|bench| bench.safety = SafetyStatus::from_flags(flag));
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
        let result = with_wrong(|bench| bench.safety = SafetyStatus::from_flags(flag));
        assert_eq!(result, (ArmingBlockers::SAFETY_STOP, ArmingState::Disarmed));
    }
}

#[test]
fn a_low_battery_blocks_arming_but_does_not_disarm() {
    let result =
        with_wrong(|bench| bench.safety = SafetyStatus::from_flags(SafetyFlags::BATTERY_LOW));
    assert_eq!(result, (ArmingBlockers::BATTERY_LOW, ArmingState::Armed));
}

#[test]
fn arming_needs_every_joint_set_up_and_without_a_fault() {
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
fn the_read_only_step_blocks_arming_and_disarms() {
    let result = with_wrong(|bench| bench.read_only = true);
    assert_eq!(
        result,
        (ArmingBlockers::BRING_UP_READ_ONLY, ArmingState::Disarmed)
    );
}

/// A robot whose pilot requested arming while flash was being written.
fn requested_while_flash_is_busy() -> Bench {
    let mut bench = Bench::new();
    bench.flash_busy = true;
    bench.run(1);
    bench.flip_on();
    bench
}

#[test]
fn a_request_while_flash_is_busy_arms_when_flash_is_done() {
    let result = with_wrong(|bench| bench.flash_busy = true);
    assert_eq!(result, (ArmingBlockers::FLASH_BUSY, ArmingState::Armed));
    let mut bench = requested_while_flash_is_busy();
    let status = bench.run(600);
    assert_eq!(status.blockers, ArmingBlockers::FLASH_BUSY);
    assert!(status.waiting);
    assert_eq!(status.refused, ArmingBlockers::NONE);
    bench.flash_busy = false;
    let status = bench.run(1);
    assert_eq!(status.state, ArmingState::Armed);
    assert!(!status.waiting);
}

/// The samples have a gap where the chip stood still.
#[test]
fn a_request_waits_for_the_attitude_to_settle_after_an_erase() {
    let mut bench = requested_while_flash_is_busy();
    bench.run(10);
    bench.estimate_valid = false;
    bench.safety =
        SafetyStatus::from_flags(SafetyFlags::ESTIMATE_INVALID.union(SafetyFlags::IMU_STALE));
    assert!(bench.run(100).waiting);
    bench.flash_busy = false;
    assert!(bench.run(500).waiting);
    bench.estimate_valid = true;
    bench.safety = SafetyStatus::from_flags(SafetyFlags::NONE);
    assert_eq!(bench.run(1).state, ArmingState::Armed);
    // The next request has nothing to wait for.
    bench.flip_off();
    bench.run(1);
    bench.estimate_valid = false;
    bench.flip_on();
    assert!(!bench.run(1).waiting);
}

#[test]
fn a_request_does_not_wait_forever() {
    for (waited_ms, waiting) in [(2_999, true), (3_002, false)] {
        let mut bench = requested_while_flash_is_busy();
        assert_eq!(bench.run(waited_ms).waiting, waiting);
    }
}

#[test]
fn any_other_fault_refuses_a_waiting_request() {
    let spoils: [fn(&mut Bench); 7] = [
        |bench| bench.sticks_centred = false,
        |bench| bench.calibrated = false,
        |bench| bench.remote_age_us = 100_001,
        |bench| bench.read_only = true,
        |bench| bench.motor.joints[0].state = JointState::Fault,
        |bench| bench.safety = SafetyStatus::from_flags(SafetyFlags::E_STOP),
        |bench| bench.safety = SafetyStatus::from_flags(SafetyFlags::JOINT_SILENT),
    ];
    for inject in spoils {
        let mut bench = requested_while_flash_is_busy();
        assert!(bench.run(10).waiting);
        inject(&mut bench);
        assert!(!bench.run(1).waiting);
        bench.flash_busy = false;
        assert_eq!(bench.run(10).state, ArmingState::Disarmed);
    }
}

#[test]
fn faulty_wheels_block_arming_but_do_not_disarm() {
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
fn a_joint_beyond_its_limits_blocks_arming_but_does_not_disarm() {
    for joint in 0..4 {
        let result = with_wrong(|bench| bench.motor.joints[joint].pos_rad = -6.3);
        assert_eq!(
            result,
            (ArmingBlockers::JOINT_OUT_OF_LIMITS, ArmingState::Armed)
        );
    }
}

/// A new robot tests the directions of its joints before their zeros are set.
#[test]
fn a_joint_beyond_its_limits_may_be_tested_in_bring_up() {
    let result = with_wrong(|bench| {
        bench.motor.joints[1].pos_rad = 6.3;
        bench.tests_motors = true;
    });
    assert_eq!(result, (ArmingBlockers::NONE, ArmingState::Armed));
}

#[test]
fn refused_settings_block_arming() {
    let result = with_wrong(|bench| bench.params.refused = 1);
    let expected = (ArmingBlockers::SETTINGS_REFUSED, ArmingState::Armed);
    assert_eq!(result, expected);
}

#[test]
fn an_unsettled_attitude_blocks_arming_but_does_not_disarm() {
    let result = with_wrong(|bench| bench.attitude_settled = false);
    let expected = (ArmingBlockers::ATTITUDE_UNSETTLED, ArmingState::Armed);
    assert_eq!(result, expected);
}

#[test]
fn a_debugger_with_vector_catch_blocks_arming_but_does_not_disarm() {
    let result = with_wrong(|bench| bench.debugger_catches = true);
    let expected = (ArmingBlockers::DEBUGGER_CATCHES, ArmingState::Armed);
    assert_eq!(result, expected);
}

#[test]
fn joint_motors_without_a_timeout_block_arming() {
    let result = with_wrong(|bench| bench.joint_timeout_unset = true);
    let expected = (ArmingBlockers::JOINT_TIMEOUT_UNSET, ArmingState::Armed);
    assert_eq!(result, expected);
}

#[test]
fn a_deflected_stick_blocks_arming_but_does_not_disarm() {
    let result = with_wrong(|bench| bench.sticks_centred = false);
    let expected = (ArmingBlockers::STICKS_NOT_CENTRED, ArmingState::Armed);
    assert_eq!(result, expected);
}

#[test]
fn a_moment_without_a_clear_switch_position_disarms_and_is_no_request() {
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
fn blockers_have_distinct_bits_in_table_order() {
    let bits = BLOCKER_NAMES.map(|(blocker, _)| blocker.bits());
    assert!(bits.iter().all(|bits| bits.count_ones() == 1), "{bits:x?}");
    assert!(
        bits.is_sorted_by(|lower, higher| lower < higher),
        "{bits:x?}"
    );
    let both = ArmingBlockers::REMOTE_NOT_FRESH.union(ArmingBlockers::FLASH_BUSY);
    assert!(both.names().eq(["remote-not-fresh", "flash-busy"]));
}
