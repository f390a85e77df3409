use super::*;

struct Bench {
    arming: Arming,
    config: SafetyConfig,
    now_us: u64,
    enabled: bool,
    disabled: bool,
    calibrated: bool,
    read_only: bool,
    flash_busy: bool,
    params: ParamStatus,
    debugger_catches: bool,
    joint_timeout_unset: bool,
    vx: f32,
    motor: MotorFeedback,
    safety: SafetyStatus,
}

impl Bench {
    fn new() -> Self {
        let mut motor = MotorFeedback::default();
        for joint in &mut motor.joints {
            joint.state = JointState::Disabled;
        }
        Self {
            arming: Arming::default(),
            config: SafetyConfig::default(),
            now_us: 1_000_000,
            enabled: false,
            disabled: true,
            calibrated: true,
            read_only: false,
            flash_busy: false,
            params: ParamStatus::default(),
            debugger_catches: false,
            joint_timeout_unset: false,
            vx: 0.0,
            motor,
            safety: SafetyStatus::of(SafetyFlags::NONE),
        }
    }

    fn flip_on(&mut self) {
        (self.enabled, self.disabled) = (true, false);
    }

    fn run(&mut self, milliseconds: u64) -> ArmingStatus {
        let mut status = ArmingStatus::default();
        for _ in 0..milliseconds {
            self.now_us += 1_000;
            let inputs = ArmingInputs {
                config: &self.config,
                remote: &RemoteState {
                    vx: self.vx,
                    ..RemoteState::default()
                },
                remote_age_us: 5_000,
                operator: &OperatorState {
                    enabled: self.enabled,
                    disabled: self.disabled,
                    e_stop: false,
                    ..OperatorState::default()
                },
                estimate_valid: true,
                calibrated: self.calibrated,
                motor: &self.motor,
                read_only: self.read_only,
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

#[test]
fn a_request_waits_a_while_for_the_calibration_but_not_for_ever() {
    let mut bench = Bench::new();
    bench.calibrated = false;
    bench.run(1);
    bench.flip_on();
    assert_eq!(
        bench.run(2_000).blockers,
        ArmingBlockers::CALIBRATION_PENDING
    );
    bench.calibrated = true;
    assert_eq!(bench.run(1).state, ArmingState::Armed);

    let mut late = Bench::new();
    late.calibrated = false;
    late.run(1);
    late.flip_on();
    late.run(3_100);
    late.calibrated = true;
    assert_eq!(late.run(1).blockers, ArmingBlockers::ENABLE_NOT_CYCLED);
}

/// Blockers when the switch is flipped with this one thing wrong, and whether the robot stays armed when it goes
/// wrong later.
fn with_wrong(spoil: impl Fn(&mut Bench)) -> (ArmingBlockers, ArmingState) {
    let mut before = Bench::new();
    before.run(1);
    before.flip_on();
    spoil(&mut before);
    let blockers = before.run(1).blockers;

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

#[test]
fn a_flip_while_flash_is_busy_arms_when_it_is_done() {
    let result = with_wrong(|bench| bench.flash_busy = true);
    assert_eq!(result, (ArmingBlockers::FLASH_BUSY, ArmingState::Armed));
    let mut bench = Bench::new();
    bench.flash_busy = true;
    bench.run(1);
    bench.flip_on();
    assert_eq!(bench.run(600).blockers, ArmingBlockers::FLASH_BUSY);
    bench.flash_busy = false;
    assert_eq!(bench.run(1).state, ArmingState::Armed);
}

#[test]
fn refused_settings_forbid_arming() {
    let result = with_wrong(|bench| bench.params.refused = 1);
    let expected = (ArmingBlockers::SETTINGS_REFUSED, ArmingState::Armed);
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
fn a_stick_off_centre_or_without_a_value_forbids_arming() {
    for vx in [0.5, -0.5, f32::NAN] {
        let result = with_wrong(|bench| bench.vx = vx);
        let expected = (ArmingBlockers::STICKS_NOT_CENTRED, ArmingState::Armed);
        assert_eq!(result, expected);
    }
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
}
