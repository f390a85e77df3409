//! Wheels that slip, spin or contradict each other.

use super::{super::slip::SlipState, *};

/// The wheels spin up to 2 m/s within 0.1 s. Nothing accelerates the robot.
fn spin_up(bench: &mut Bench) {
    for sample in 1..=20 {
        let mps = 0.1 * sample as f32;
        bench.wheels_run([mps, mps]);
        bench.sample();
    }
}

/// The robot is pushed or carried, so the zero-velocity detector does not help. The wheels slip from the first sample
/// on.
#[test]
fn slipping_wheels_of_a_pushed_robot_are_rejected_for_two_seconds() {
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

/// With the wheels in the air and the body at rest, they may spin at any speed, together or against each other, for any
/// time.
#[test]
fn spinning_wheels_do_not_move_a_robot_at_rest() {
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

/// As with a thumb on the stick: 0.3 m/s² that the accelerometer does not measure.
#[test]
fn wheels_that_spin_up_slowly_are_detected() {
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

/// On very smooth ice the robot accelerates by 0.2 m/s², less than what ends a quiet sample. It moves all the same.
#[test]
fn a_robot_that_glides_on_spinning_wheels_is_not_held() {
    let mut bench = Bench::on_wheels();
    bench.accel_mps2 = [0.2, 0.0, GRAVITY_MPS2];
    bench.wheels_run([1.5, 1.5]);
    bench.run(1.9);
    let mps = bench.forward_mps();
    assert!((0.15..0.5).contains(&mps), "{mps} of 0.38");
}

/// While driving, one wheel departs from what the yaw rate allows. The other is used.
#[test]
fn of_two_inconsistent_wheels_the_one_further_off_slips() {
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
fn one_slipping_wheel_is_ignored_while_it_slips() {
    let mut bench = Bench::on_wheels();
    bench.wheels_run([0.0, 1.5]);
    bench.run(10.0);
    assert!(bench.forward_mps().abs() < 0.02, "{}", bench.forward_mps());
}

#[test]
fn a_wheel_rolls_again_after_its_speed_agrees_for_a_tenth_of_a_second() {
    let mut slip_state = SlipState::Rolling;
    for _ in 0..100 {
        slip_state = slip_state.step(0.29, DT_S);
    }
    assert!(slip_state.is_rolling());
    slip_state = slip_state.step(-0.31, DT_S);
    assert!(!slip_state.is_rolling());
    // The wheel's speed passes the robot's.
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
