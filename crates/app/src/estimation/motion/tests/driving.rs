//! Driving, turning and being carried, with wheels that are heard.

use super::*;

#[test]
fn speed_and_way_follow_a_drive() {
    let mut bench = Bench::on_wheels();
    bench.drive(0.0, 1.0, 0.5);
    assert!((bench.forward_mps() - 1.0).abs() < 0.01);
    bench.run(2.0);
    bench.drive(1.0, 0.0, 0.5);
    bench.run(1.0);
    // 1 m/s for the 2.5 s between the middles of the ramps.
    assert_close(bench.position_m(), [2.5, 0.0, 0.0], 0.02);
    assert_close(bench.velocity_mps(), [0.0; 3], 1e-4);
}

/// Offset forward and to the left while driving, so that no rest shows it.
#[test]
fn an_offset_is_learnt_while_driving() {
    let mut bench = Bench::on_wheels();
    bench.drive(0.0, 1.0, 0.5);
    bench.run(2.0);
    bench.accel_mps2 = [0.2, -0.1, GRAVITY_MPS2];
    bench.run(8.0);
    assert_close(bench.motion.accel_bias_mps2(), [0.2, -0.1, 0.0], 5e-3);
    assert_close(bench.velocity_mps(), [1.0, 0.0, 0.0], 5e-3);
}

/// Nothing but sensor values tells a constant speed from rest; turning wheels do.
#[test]
fn a_constant_speed_is_not_taken_for_rest() {
    let mut bench = Bench::on_wheels();
    bench.drive(0.0, 0.05, 0.1);
    bench.run(20.0);
    assert!((bench.forward_mps() - 0.05).abs() < 1e-3);
    let [x, ..] = bench.position_m();
    assert!((x - 1.0).abs() < 0.02, "{x}");
}

#[test]
fn moving_off_after_a_long_rest_is_followed_at_once() {
    let mut bench = Bench::on_wheels();
    bench.run(600.0);
    bench.drive(0.0, 0.4, 0.1);
    assert!((bench.forward_mps() - 0.4).abs() < 0.02);
}

/// On its own a wheel runs slower inside a left turn by yaw rate · half the track: 2 rad/s · 0.21 m.
#[test]
fn one_wheel_and_the_yaw_rate_are_enough() {
    for silent in [0, 1] {
        let mut bench = Bench::on_wheels();
        bench.pose.rate_rps = [0.0, 0.0, 2.0];
        bench.wheels_run([-0.42, 0.42]);
        bench.motor.wheels[silent].age_us = 50_001;
        bench.run(1.0);
        assert_close(bench.velocity_mps(), [0.0; 3], 1e-3);
    }
}

/// The motor turns with the body: leaning forward at 1 rad/s over wheels that stand turns the rotor backward by 1 rad/s
/// of the wheel.
#[test]
fn pitching_over_standing_wheels_is_no_motion() {
    let mut bench = Bench::on_wheels();
    bench.pose.rate_rps = [0.0, 1.0, 0.0];
    bench.wheels_run([-0.06, -0.06]);
    bench.run(0.5);
    assert_close(bench.velocity_mps(), [0.0; 3], 1e-2);
}

/// Wheels spinning, so that nothing corrects; pushed east at 2 m/s² for a second while it turns at 20 rad/s. Each sample
/// is the force's mean over its interval, in axes that turn meanwhile.
#[test]
fn a_force_is_taken_where_the_body_was_in_the_middle_of_its_sample() {
    let mut bench = Bench::on_wheels();
    bench.wheels_run([5.0, 5.0]);
    bench.pose.rate_rps = [0.0, 0.0, 20.0];
    for sample in 1..=200_u16 {
        let end_rad = 20.0 * f64::from(sample) * 0.005;
        let (sin, cos) = (end_rad - 0.05).sin_cos();
        let mean = 2.0 * 0.05_f64.sin() / 0.05;
        bench.accel_mps2 = [(mean * cos) as f32, (-mean * sin) as f32, GRAVITY_MPS2];
        bench.pose.orientation = turned_left(end_rad);
        bench.sample();
    }
    assert_close(bench.velocity_mps(), [2.0, 0.0, 0.0], 0.02);
}

/// Somebody carries the robot off, its wheels stand: they explain no force.
#[test]
fn standing_wheels_accelerate_nothing() {
    let mut bench = Bench::on_wheels();
    bench.run(1.0);
    for sample in 0..400 {
        let push_mps2 = (0.02 * sample as f32).sin();
        bench.accel_mps2 = [push_mps2, -push_mps2, GRAVITY_MPS2];
        bench.sample();
        assert_eq!(bench.motion.kinematic_mps2(), [0.0; 3], "{sample}");
    }
}

/// Round a circle of 0.5 m at 2 rad/s, the IMU's samples turned with the body: all of the force is kinematic.
#[test]
fn a_circle_is_no_tilt() {
    let mut bench = Bench::on_wheels();
    bench.drive(0.0, 1.0, 0.5);
    bench.accel_mps2 = [0.0, 2.0, GRAVITY_MPS2];
    bench.pose.rate_rps = [0.0, 0.0, 2.0];
    bench.wheels_run([0.58, 1.42]);
    for sample in 1..=1_000_u16 {
        bench.pose.orientation = turned_left(2.0 * 0.005 * f64::from(sample));
        bench.sample();
        assert_close(bench.motion.kinematic_mps2(), [0.0, 2.0, 0.0], 0.1);
    }
}
