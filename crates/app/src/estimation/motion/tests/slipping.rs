//! Wheels that slip, spin or contradict each other.

use super::{super::slip::SlipState, *};

/// Wheels spin up to 2 m/s within 0.1 s, nothing accelerates the robot.
fn spin_up(bench: &mut Bench) {
    for sample in 1..=20 {
        let mps = 0.1 * sample as f32;
        bench.wheels_run([mps, mps]);
        bench.sample();
    }
}

/// Somebody carries the robot, or it is pushed: slip from the first samples on, for 2 s.
#[test]
fn slipping_wheels_of_a_shaken_robot_are_not_believed_for_two_seconds() {
    let mut bench = Bench::on_wheels();
    bench.accel_mps2 = [0.0, 0.5, GRAVITY_MPS2];
    bench.sample();
    bench.accel_mps2 = [0.0, 0.0, GRAVITY_MPS2];
    spin_up(&mut bench);
    bench.run(1.8);
    assert!(bench.forward_mps().abs() < 0.1, "{}", bench.forward_mps());
    bench.run(0.4);
    assert!((bench.forward_mps() - 2.0).abs() < 0.1);
}

/// In the air, body at rest: whatever the wheels do, fast or slow, together or against each other, for however long.
#[test]
fn wheels_that_spin_beside_a_robot_at_rest_move_nothing() {
    let mut bench = Bench::on_wheels();
    let speeds = [
        [2.0, 2.0],
        [0.5, 0.5],
        [0.2, 0.2],
        [-0.4, 0.4],
        [-1.0, -1.0],
        [0.6, 0.0],
    ];
    for [left, right] in speeds {
        for share in 1..=20 {
            let share = share as f32 / 20.0;
            bench.wheels_run([share * left, share * right]);
            bench.sample();
        }
        for _ in 0..2_000 {
            bench.sample();
            let [x, y, _] = bench.velocity_mps();
            assert!(x.hypot(y) < 0.15, "{left} {right}: {x} {y}");
        }
        assert_close(bench.velocity_mps(), [0.0; 3], 0.02);
        bench.wheels_run([0.0; 2]);
        bench.run(0.6);
        assert_close(bench.velocity_mps(), [0.0; 3], 1e-3);
        let [x, y, _] = bench.position_m();
        assert!(x.hypot(y) < 0.05, "{x} {y}");
    }
    bench.drive(0.0, 1.0, 0.5);
    assert!((bench.forward_mps() - 1.0).abs() < 0.02, "it drives off");
}

/// As a thumb pushes the stick: 0.3 m/s² that nothing feels.
#[test]
fn wheels_that_spin_up_slowly_are_found_out() {
    let mut bench = Bench::on_wheels();
    for sample in 0..800 {
        let mps = (0.3 * 0.005 * sample as f32).min(0.6);
        bench.wheels_run([mps, mps]);
        bench.sample();
        assert!(
            bench.forward_mps().abs() < 0.2,
            "{} at {mps}",
            bench.forward_mps()
        );
    }
    assert!(bench.forward_mps().abs() < 0.02, "{}", bench.forward_mps());
}

/// Very smooth ice: 0.2 m/s², less than what shakes a robot. It moves off all the same.
#[test]
fn a_robot_that_glides_away_under_spinning_wheels_is_not_held() {
    let mut bench = Bench::on_wheels();
    bench.accel_mps2 = [0.2, 0.0, GRAVITY_MPS2];
    bench.wheels_run([1.5, 1.5]);
    bench.run(1.9);
    let mps = bench.forward_mps();
    assert!((0.15..0.5).contains(&mps), "{mps} of 0.38");
}

/// Driving, one wheel runs away from what the gyro says: the other one is believed.
#[test]
fn of_two_wheels_that_contradict_the_gyro_the_one_further_off_slips() {
    let mut bench = Bench::on_wheels();
    bench.drive(0.0, 1.0, 0.5);
    bench.run(4.0);
    for sample in 1..=400 {
        let more = 0.002 * sample as f32;
        bench.wheels_run([1.0, 1.0 + more]);
        bench.sample();
    }
    bench.run(5.0);
    assert!(
        (bench.forward_mps() - 1.0).abs() < 0.05,
        "{}",
        bench.forward_mps()
    );
}

#[test]
fn one_slipping_wheel_is_left_out_for_as_long_as_it_slips() {
    let mut bench = Bench::on_wheels();
    bench.wheels_run([0.0, 1.5]);
    bench.run(10.0);
    assert!(bench.forward_mps().abs() < 0.02, "{}", bench.forward_mps());
}

#[test]
fn grip_returns_once_the_speeds_agree_for_a_tenth_of_a_second() {
    let mut slip_state = SlipState::Rolling;
    for _ in 0..100 {
        slip_state = slip_state.step(0.29, DT_S);
    }
    assert!(slip_state.is_rolling());
    slip_state = slip_state.step(-0.31, DT_S);
    assert!(!slip_state.is_rolling());
    // It passes by.
    for _ in 0..15 {
        slip_state = slip_state.step(0.02, DT_S);
    }
    slip_state = slip_state.step(0.2, DT_S);
    for _ in 0..19 {
        slip_state = slip_state.step(0.02, DT_S);
        assert!(!slip_state.is_rolling());
    }
    slip_state = slip_state.step(0.02, DT_S).step(0.02, DT_S);
    assert!(slip_state.is_rolling());
}
