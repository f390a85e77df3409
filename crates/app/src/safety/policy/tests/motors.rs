//! Silent, faulty, frozen and hot motors.

use super::*;

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
