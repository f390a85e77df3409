use super::*;
use crate::{domain::BusId, safety::SafetyVerdict};

/// A policy and its inputs. Initially nothing is wrong, and one tick has run.
struct Bench {
    policy: SafetyPolicy,
    config: SafetyConfig,
    remote: RemoteDiagnostics,
    operator: OperatorState,
    estimate: StateEstimate,
    motor: MotorFeedback,
    health: SystemHealth,
    imu_age_us: u64,
    command_age_us: u64,
    may_resume: bool,
    now_us: u64,
}

impl Bench {
    fn new() -> Self {
        let mut motor = MotorFeedback::default();
        for wheel in &mut motor.wheels {
            wheel.age_us = 1_000;
        }
        for joint in &mut motor.joints {
            joint.age_us = 2_000;
            joint.state = JointState::Disabled;
            joint.temperature_c = 30.0;
        }
        let mut bench = Self {
            policy: SafetyPolicy::default(),
            config: SafetyConfig::default(),
            remote: RemoteDiagnostics {
                quality: 1.0,
                frames: 100,
                age_us: 7_000,
                ..RemoteDiagnostics::default()
            },
            operator: OperatorState {
                e_stop: false,
                ..OperatorState::default()
            },
            estimate: StateEstimate {
                valid: true,
                ..StateEstimate::default()
            },
            motor,
            health: SystemHealth {
                battery_v: 24.0,
                ..SystemHealth::default()
            },
            imu_age_us: 5_000,
            command_age_us: 10_000,
            may_resume: true,
            now_us: 10_000_000,
        };
        bench.tick();
        bench
    }

    /// Runs one tick without advancing the time.
    fn tick(&mut self) -> SafetyStatus {
        self.policy.evaluate(
            &SafetyInputs {
                config: &self.config,
                remote: &self.remote,
                operator: &self.operator,
                may_resume: self.may_resume,
                imu_ts_us: self.now_us - self.imu_age_us,
                estimate: &self.estimate,
                motor: &self.motor,
                motor_timeout_us: 50_000,
                command_ts_us: self.now_us - self.command_age_us,
                health: &self.health,
            },
            self.now_us,
        )
    }

    /// Runs ticks of 1 ms and returns the last status.
    fn run(&mut self, milliseconds: u32) -> SafetyStatus {
        let mut status = self.tick();
        for _ in 0..milliseconds {
            self.now_us += 1_000;
            status = self.tick();
        }
        status
    }

    /// Milliseconds until the flag is set, or `None` if that takes more than three seconds.
    fn ms_until(&mut self, flag: SafetyFlags) -> Option<u32> {
        (1..=3_000).find(|_| {
            self.now_us += 1_000;
            self.tick().flags.intersects(flag)
        })
    }

    /// Enable off and e-stop thrown.
    fn gesture(&mut self, on: bool) {
        self.operator.disabled = on;
        self.operator.e_stop = on;
    }
}

/// The first tick after one change to a healthy robot.
fn with_change(change: impl FnOnce(&mut Bench)) -> SafetyStatus {
    let mut bench = Bench::new();
    change(&mut bench);
    bench.tick()
}

fn stops(status: &SafetyStatus) -> [bool; 4] {
    let [can1, can2] = [BusId::Can1, BusId::Can2];
    [
        status.stops_wheels(can1),
        status.stops_wheels(can2),
        status.stops_joints(can1),
        status.stops_joints(can2),
    ]
}

#[test]
fn without_faults_nothing_is_stopped() {
    let status = Bench::new().run(3_000);
    assert_eq!(status.flags, SafetyFlags::NONE);
    assert_eq!(status.verdict, SafetyVerdict::Run);
    assert_eq!(stops(&status), [false; 4]);
}

#[test]
fn a_faulty_bus_stops_only_its_own_actuators() {
    let cases = [
        (0, SafetyFlags::CAN1_FAULT, SafetyFlags::CAN1_CONGESTED),
        (1, SafetyFlags::CAN2_FAULT, SafetyFlags::CAN2_CONGESTED),
    ];
    for (bus, fault, congestion) in cases {
        let off = with_change(|bench| bench.health.can[bus].state = BusErrorState::BusOff);
        let congested = with_change(|bench| bench.health.can[bus].tx_failures_in_row = 21);
        assert_eq!((off.flags, congested.flags), (fault, congestion));
        for status in [off, congested] {
            assert_eq!(status.verdict, SafetyVerdict::PartialStop);
            assert_eq!(stops(&status), [bus == 0, bus == 1, bus == 0, bus == 1]);
        }
    }
}

/// The limit is 20.
#[test]
fn accumulated_sensor_errors_stop_everything_until_cleared() {
    type Fault = fn(&mut Bench);
    let imu: Fault = |bench| bench.health.imu.errors = 21;
    let mag: Fault = |bench| bench.health.mag.errors = 21;
    let cases = [
        (imu, SafetyFlags::IMU_ERRORS),
        (mag, SafetyFlags::MAG_ERRORS),
    ];
    for (inject, flag) in cases {
        let mut bench = Bench::new();
        inject(&mut bench);
        assert_eq!(bench.tick().flags, flag);
        let later = bench.run(10_000);
        assert_eq!((later.flags, later.latched), (flag, flag));
        assert_eq!(stops(&later), [true; 4]);
        bench.gesture(true);
        bench.run(1_001);
        bench.gesture(false);
        assert_eq!(bench.tick().flags, SafetyFlags::NONE);
    }
}

/// With default settings a value at its limit is allowed, and the next one is not.
#[test]
fn values_at_their_limits_are_allowed() {
    type Set = fn(&mut Bench, u32);
    let cases: [(Set, SafetyFlags); 7] = [
        (
            |bench, more| bench.remote.age_us = 100_000 + more,
            SafetyFlags::REMOTE_LOST,
        ),
        (
            |bench, more| bench.imu_age_us = u64::from(25_000 + more),
            SafetyFlags::IMU_STALE,
        ),
        (
            |bench, more| bench.command_age_us = u64::from(50_000 + more),
            SafetyFlags::COMMAND_STALE,
        ),
        (
            |bench, more| bench.motor.wheels[0].age_us = 50_000 + more,
            SafetyFlags::WHEEL_LEFT_SILENT,
        ),
        (
            |bench, more| bench.motor.wheels[1].age_us = 50_000 + more,
            SafetyFlags::WHEEL_RIGHT_SILENT,
        ),
        (
            |bench, more| bench.motor.joints[3].age_us = 50_000 + more,
            SafetyFlags::JOINT_SILENT,
        ),
        (
            |bench, more| bench.health.can[0].tx_failures_in_row = 20 + more,
            SafetyFlags::CAN1_CONGESTED,
        ),
    ];
    for (set, flag) in cases {
        assert_eq!(with_change(|bench| set(bench, 0)).flags, SafetyFlags::NONE);
        assert_eq!(with_change(|bench| set(bench, 1)).flags, flag);
    }
}

#[test]
fn quality_is_not_judged_before_the_first_frame() {
    let silent = with_change(|bench| (bench.remote.frames, bench.remote.quality) = (0, 0.0));
    assert_eq!(silent.flags, SafetyFlags::NONE);
}

#[test]
fn a_late_task_stops_everything() {
    let late = with_change(|bench| bench.health.late_tasks.status = true);
    assert_eq!(late.flags, SafetyFlags::TASK_LATE);
    assert_eq!(late.verdict, SafetyVerdict::GlobalStop);
}

#[test]
fn a_bad_link_stops_everything() {
    let lossy = with_change(|bench| bench.remote.quality = 0.49);
    let unknown = with_change(|bench| bench.remote.quality = f32::NAN);
    let silent = with_change(|bench| bench.remote.age_us = 100_001);
    let failsafe = with_change(|bench| bench.remote.failsafe = true);
    assert_eq!(lossy.flags, SafetyFlags::REMOTE_QUALITY);
    assert_eq!(unknown.flags, SafetyFlags::REMOTE_QUALITY);
    assert_eq!(silent.flags, SafetyFlags::REMOTE_LOST);
    assert_eq!(failsafe.flags, SafetyFlags::REMOTE_FAILSAFE);
    for status in [lossy, unknown, silent, failsafe] {
        assert_eq!(status.verdict, SafetyVerdict::GlobalStop);
        assert_eq!(stops(&status), [true; 4]);
    }
}

#[test]
fn each_silent_wheel_has_a_flag_and_stops_nothing() {
    let left = with_change(|bench| bench.motor.wheels[0].age_us = 50_001);
    let right = with_change(|bench| bench.motor.wheels[1].age_us = 50_001);
    assert_eq!(left.flags, SafetyFlags::WHEEL_LEFT_SILENT);
    assert_eq!(right.flags, SafetyFlags::WHEEL_RIGHT_SILENT);
    assert_eq!(stops(&left), [false; 4]);
}

#[test]
fn a_faulty_joint_stops_all_joints_and_no_wheel() {
    type Fault = fn(&mut Bench, usize);
    let cases: [(Fault, SafetyFlags, bool); 4] = [
        (
            |bench, joint| bench.motor.joints[joint].state = JointState::Silent,
            SafetyFlags::JOINT_SILENT,
            false,
        ),
        (
            |bench, joint| bench.motor.joints[joint].age_us = 50_001,
            SafetyFlags::JOINT_SILENT,
            false,
        ),
        (
            |bench, joint| bench.motor.joints[joint].state = JointState::Fault,
            SafetyFlags::JOINT_FAULT,
            true,
        ),
        (
            |bench, joint| bench.motor.joints[joint].frozen = true,
            SafetyFlags::JOINT_FROZEN,
            true,
        ),
    ];
    for (inject, flag, latches) in cases {
        for joint in 0..4 {
            let mut bench = Bench::new();
            let healthy = bench.motor;
            inject(&mut bench, joint);
            let bad = bench.tick();
            assert_eq!(bad.flags, flag, "joint {joint}");
            assert_eq!(bad.verdict, SafetyVerdict::PartialStop);
            assert_eq!(stops(&bad), [false, false, true, true]);
            bench.motor = healthy;
            assert_eq!(bench.run(5_000).joints_stop, latches, "{flag:?}");
        }
    }
}

/// The limit is one second. A short silence, as when a motor takes a new setting, restarts it.
#[test]
fn a_joint_that_does_not_become_ready_stops_all_joints_until_cleared() {
    for state in [JointState::SettingUp, JointState::Enabling] {
        let mut bench = Bench::new();
        bench.motor.joints[2].state = state;
        assert_eq!(bench.run(600).flags, SafetyFlags::NONE);
        bench.motor.joints[2].state = JointState::Silent;
        bench.run(150);
        bench.motor.joints[2].state = state;
        assert_eq!(bench.ms_until(SafetyFlags::JOINT_NOT_READY), Some(1_000));
        bench.motor.joints[2].state = JointState::Disabled;
        let later = bench.run(5_000);
        assert_eq!(later.latched, SafetyFlags::JOINT_NOT_READY);
        assert_eq!(stops(&later), [false, false, true, true]);
    }
}

#[test]
fn a_frozen_wheel_stops_both_wheels_until_cleared_and_no_joint() {
    for wheel in 0..2 {
        let mut bench = Bench::new();
        bench.motor.wheels[wheel].frozen = true;
        assert_eq!(bench.tick().flags, SafetyFlags::WHEEL_FROZEN);
        bench.motor.wheels[wheel].frozen = false;
        let later = bench.run(5_000);
        assert_eq!(later.latched, SafetyFlags::WHEEL_FROZEN);
        assert_eq!(stops(&later), [true, true, false, false]);
    }
}

/// The stop comes after half a second above 90 °C and ends below 80 °C.
#[test]
fn hot_motors_stop_all_motors_of_their_kind_until_cool() {
    for wheel in 0..2 {
        let mut bench = Bench::new();
        bench.motor.wheels[wheel].temperature_c = 90;
        assert_eq!(bench.ms_until(SafetyFlags::WHEEL_HOT), None);
        bench.motor.wheels[wheel].temperature_c = 91;
        assert_eq!(bench.ms_until(SafetyFlags::WHEEL_HOT), Some(500));
        assert_eq!(stops(&bench.tick()), [true, true, false, false]);
        bench.motor.wheels[wheel].temperature_c = 81;
        assert!(bench.run(3_000).wheels_stop);
        bench.motor.wheels[wheel].temperature_c = 80;
        assert!(!bench.run(1).wheels_stop);
        bench.motor.wheels[wheel].temperature_c = 91;
        assert_eq!(bench.ms_until(SafetyFlags::WHEEL_HOT), Some(500));
    }
    for joint in 0..4 {
        let mut bench = Bench::new();
        bench.motor.joints[joint].temperature_c = 90.1;
        assert_eq!(bench.ms_until(SafetyFlags::JOINT_HOT), Some(500));
        assert_eq!(stops(&bench.tick()), [false, false, true, true]);
        bench.motor.joints[joint].temperature_c = 79.0;
        assert!(!bench.run(1).joints_stop);
        bench.motor.joints[joint].temperature_c = f32::NAN;
        assert_eq!(bench.ms_until(SafetyFlags::JOINT_HOT), Some(500));
    }
}

#[test]
fn a_single_wrong_temperature_stops_nothing() {
    let mut bench = Bench::new();
    for _ in 0..10 {
        bench.motor.wheels[0].temperature_c = 255;
        assert!(!bench.run(499).wheels_stop);
        bench.motor.wheels[0].temperature_c = 40;
        assert!(!bench.run(1).wheels_stop);
    }
}

/// Arming is blocked after a second below 21 V and allowed again at 21.5 V.
#[test]
fn a_low_battery_warns_and_recovers_with_hysteresis() {
    let mut bench = Bench::new();
    bench.health.battery_v = 20.9;
    assert_eq!(bench.ms_until(SafetyFlags::BATTERY_LOW), Some(1_000));
    let low = bench.run(5_000);
    assert_eq!(
        (low.flags, low.verdict),
        (SafetyFlags::BATTERY_LOW, SafetyVerdict::Run)
    );
    bench.health.battery_v = 21.4;
    assert_eq!(bench.run(3_000).flags, SafetyFlags::BATTERY_LOW);
    bench.health.battery_v = 21.5;
    assert_eq!(bench.run(1).flags, SafetyFlags::NONE);
}

#[test]
fn an_empty_battery_stops_everything_until_cleared_and_a_sag_does_not() {
    let mut bench = Bench::new();
    for _ in 0..10 {
        bench.health.battery_v = 15.0;
        assert!(!bench.run(998).global_stop);
        bench.health.battery_v = 24.0;
        assert!(!bench.run(1).global_stop);
    }
    bench.health.battery_v = 18.9;
    assert_eq!(bench.ms_until(SafetyFlags::BATTERY_EMPTY), Some(1_000));
    bench.health.battery_v = 24.0;
    let later = bench.run(5_000);
    assert_eq!(later.flags, SafetyFlags::BATTERY_EMPTY);
    assert_eq!(stops(&later), [true; 4]);
}

#[test]
fn an_unmeasured_battery_is_low_and_nan_is_empty() {
    let mut bench = Bench::new();
    bench.health.battery_v = 0.0;
    assert_eq!(bench.run(5_000).flags, SafetyFlags::BATTERY_LOW);
    bench.health.battery_v = f32::NAN;
    assert!(bench.run(1_000).global_stop);
    let mut unwatched = Bench::new();
    unwatched.config.battery_low_v = 0.0;
    for battery_v in [0.0, 12.0] {
        unwatched.health.battery_v = battery_v;
        assert_eq!(unwatched.run(5_000).flags, SafetyFlags::NONE);
    }
}

/// Twice the arc tangent of 0.6 is 1.08 rad; the limit is 0.9 rad.
#[test]
fn a_fallen_robot_stops_until_it_is_upright_and_cleared() {
    let mut bench = Bench::new();
    let upright = bench.estimate;
    bench.estimate.q_wxyz = [0.8575, 0.5145, 0.0, 0.0];
    assert_eq!(bench.ms_until(SafetyFlags::TILT), Some(50));
    bench.gesture(true);
    bench.run(3_000);
    bench.gesture(false);
    let still_down = bench.run(100);
    assert_eq!(still_down.latched, SafetyFlags::TILT);
    assert_eq!(still_down.verdict, SafetyVerdict::GlobalStop);
    bench.estimate = upright;
    assert_eq!(bench.run(5_000).flags, SafetyFlags::TILT);
    bench.gesture(true);
    bench.run(1_001);
    bench.gesture(false);
    assert_eq!(bench.run(100).flags, SafetyFlags::NONE);
    assert_eq!(
        bench.tick().flags_seen,
        SafetyFlags::TILT.union(SafetyFlags::E_STOP)
    );
}

#[test]
fn clearing_needs_the_whole_gesture_for_a_second_over_a_good_link() {
    type Fault = fn(&mut Bench);
    let faults: [Fault; 5] = [
        |bench| bench.operator.disabled = false,
        |bench| bench.operator.e_stop = false,
        |bench| bench.remote.failsafe = true,
        |bench| bench.remote.age_us = 100_001,
        |bench| bench.remote.quality = 0.2,
    ];
    for inject in faults {
        let mut bench = Bench::new();
        bench.motor.wheels[0].frozen = true;
        bench.tick();
        bench.motor.wheels[0].frozen = false;
        bench.gesture(true);
        bench.run(999);
        let good = bench.remote;
        inject(&mut bench);
        bench.run(1);
        bench.remote = good;
        bench.gesture(true);
        assert_eq!(bench.run(999).latched, SafetyFlags::WHEEL_FROZEN);
        assert_eq!(bench.run(2).latched, SafetyFlags::NONE);
    }
}

/// The joint needs some ticks to clear its fault, and the pilot keeps the switches in place.
#[test]
fn joints_get_a_clear_order_each_second_and_the_latch_ends_with_the_fault() {
    let mut bench = Bench::new();
    bench.motor.joints[2].state = JointState::Fault;
    assert!(!bench.run(100).clear_faults);
    bench.gesture(true);
    let mut told_ms = Vec::new();
    for ms in 1..=2_500 {
        bench.now_us += 1_000;
        if bench.tick().clear_faults {
            told_ms.push(ms);
        }
    }
    assert_eq!(told_ms, [1_000, 2_000]);
    assert_eq!(bench.tick().latched, SafetyFlags::JOINT_FAULT);
    bench.motor.joints[2].state = JointState::Disabled;
    assert_eq!(bench.tick().latched, SafetyFlags::NONE);
}

/// Time that jumps, stands still or runs backwards is not a duration.
#[test]
fn a_clock_jump_neither_clears_nor_stops() {
    let mut bench = Bench::new();
    bench.motor.wheels[0].frozen = true;
    bench.tick();
    bench.motor.wheels[0].frozen = false;
    bench.gesture(true);
    bench.health.battery_v = 10.0;
    for jump_us in [3_600_000_000, 0, 5_000_000] {
        bench.now_us += jump_us;
        let status = bench.tick();
        assert_eq!(status.latched, SafetyFlags::WHEEL_FROZEN);
    }
    bench.now_us -= 1_000_000_000;
    assert_eq!(bench.tick().latched, SafetyFlags::WHEEL_FROZEN);
}

/// Returns whether wheels and joints are stopped during a partial stop, after it with the sticks deflected, and after
/// the sticks have been centred.
fn stops_around(begin: fn(&mut Bench), end: fn(&mut Bench)) -> [(bool, bool); 3] {
    let mut bench = Bench::new();
    let stops = |bench: &mut Bench| {
        let status = bench.run(20);
        let bus_1 = BusId::Can1;
        (status.stops_wheels(bus_1), status.stops_joints(BusId::Can2))
    };
    bench.may_resume = false;
    begin(&mut bench);
    let during = stops(&mut bench);
    end(&mut bench);
    let pushed = stops(&mut bench);
    let awaited = bench.tick().flags.intersects(SafetyFlags::STICKS_AWAITED);
    assert_eq!(awaited, pushed != (false, false));
    bench.may_resume = true;
    let centred = stops(&mut bench);
    assert!(!bench.tick().flags.intersects(SafetyFlags::STICKS_AWAITED));
    bench.may_resume = false;
    assert_eq!(stops(&mut bench), centred);
    [during, pushed, centred]
}

#[test]
fn after_a_partial_stop_the_part_waits_for_centred_sticks() {
    let joints = [(false, true), (false, true), (false, false)];
    let wheels = [(true, false), (true, false), (false, false)];
    let silent_joint = stops_around(
        |b| b.motor.joints[1].age_us = 60_000,
        |b| b.motor.joints[1].age_us = 2_000,
    );
    assert_eq!(silent_joint, joints);
    let bus_off = stops_around(
        |b| b.health.can[1].state = BusErrorState::BusOff,
        |b| b.health.can[1].state = BusErrorState::Active,
    );
    assert_eq!(bus_off, joints);
    let congested = stops_around(
        |b| b.health.can[0].tx_failures_in_row = 21,
        |b| b.health.can[0].tx_failures_in_row = 0,
    );
    assert_eq!(congested, wheels);
}

/// During the silence its current continues open loop. A wheel that regains its supply must not start by itself.
#[test]
fn a_wheel_that_was_silent_waits_for_centred_sticks() {
    let open_loop = [(false, false), (true, false), (false, false)];
    for wheel in [
        stops_around(
            |b| b.motor.wheels[0].age_us = 60_000,
            |b| b.motor.wheels[0].age_us = 1_000,
        ),
        stops_around(
            |b| b.motor.wheels[1].age_us = 60_000,
            |b| b.motor.wheels[1].age_us = 1_000,
        ),
    ] {
        assert_eq!(wheel, open_loop);
    }
}

#[test]
fn a_setting_allows_immediate_resumption() {
    let at_once = stops_around(
        |b| {
            b.config.resume_centred = 0;
            b.motor.joints[1].age_us = 60_000;
        },
        |b| b.motor.joints[1].age_us = 2_000,
    );
    assert_eq!(at_once, [(false, true), (false, false), (false, false)]);
}

/// A second cause that begins during the first one's stop is remembered as well.
#[test]
fn centred_sticks_count_only_after_all_causes_have_ended() {
    let mut bench = Bench::new();
    bench.may_resume = false;
    bench.motor.joints[1].age_us = 60_000;
    bench.run(5);
    bench.may_resume = true;
    assert!(bench.run(5).joints_stop);
    bench.may_resume = false;
    bench.motor.joints[1].age_us = 2_000;
    assert!(bench.run(5).joints_stop);
    bench.may_resume = true;
    assert!(!bench.run(1).joints_stop);
}
