//! Driving, turning and being carried, with wheel feedback.

use super::*;

#[test]
fn speed_and_position_follow_a_drive() {
    let mut bench = Bench::on_wheels();
    bench.drive(0.0, 1.0, 0.5);
    assert!((bench.forward_mps() - 1.0).abs() < 0.01);
    bench.run(2.0);
    bench.drive(1.0, 0.0, 0.5);
    bench.run(1.0);
    // 1 m/s over the 2.5 s between the middles of the two ramps.
    assert_close(bench.position_m(), [2.5, 0.0, 0.0], 0.02);
    assert_close(bench.velocity_mps(), [0.0; 3], 1e-4);
}

/// The bias appears while the robot drives, so that no standstill shows it.
#[test]
fn the_accelerometer_bias_is_found_while_driving() {
    let mut bench = Bench::on_wheels();
    bench.drive(0.0, 1.0, 0.5);
    bench.run(2.0);
    bench.accel_mps2 = [0.2, -0.1, GRAVITY_MPS2];
    bench.run(8.0);
    assert_close(bench.motion.accel_bias_mps2(), [0.2, -0.1, 0.0], 5e-3);
    assert_close(bench.velocity_mps(), [1.0, 0.0, 0.0], 5e-3);
}

/// The IMU cannot tell constant speed from rest, but the wheels can.
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

/// In a left turn the left wheel runs slower than the middle by yaw rate · half the track, 2 rad/s · 0.21 m.
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

/// The motor pitches with the body. If the body leans forward at 1 rad/s over standing wheels, the rotor turns backward
/// by 1 rad/s of the wheel.
#[test]
fn pitching_over_standing_wheels_is_no_motion() {
    let mut bench = Bench::on_wheels();
    bench.pose.rate_rps = [0.0, 1.0, 0.0];
    bench.wheels_run([-0.06, -0.06]);
    bench.run(0.5);
    assert_close(bench.velocity_mps(), [0.0; 3], 1e-2);
}

/// The wheels spin, so that nothing corrects the velocity. The robot is pushed east at 2 m/s² for a second while it
/// turns at 20 rad/s. Each sample is the mean force over its interval, in rotating axes.
#[test]
fn a_force_is_rotated_from_the_middle_of_its_sample() {
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

/// Somebody carries the robot. Its wheels stand and explain no force.
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

/// On a circle with a radius of 0.5 m at 2 rad/s, all of the horizontal force is kinematic.
#[test]
fn the_force_of_a_circle_is_kinematic() {
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
