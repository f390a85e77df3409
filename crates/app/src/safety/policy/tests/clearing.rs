//! Latched stops, and the pilot's gesture that clears them.

use super::*;

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
