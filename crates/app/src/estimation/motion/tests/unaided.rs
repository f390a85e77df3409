//! No wheels, no IMU samples, and extreme inputs.

use super::*;

/// The wheels fall silent at 1 m/s, and the accelerometer has a bias of 0.3 m/s². The velocity follows it for 2 s and
/// then decays.
#[test]
fn without_wheels_the_velocity_decays_and_the_position_stays() {
    let mut bench = Bench::on_wheels();
    bench.drive(0.0, 1.0, 0.5);
    bench.motor = MotorFeedback::default();
    bench.accel_mps2 = [0.3, 0.0, GRAVITY_MPS2];
    bench.run(1.9);
    assert!((bench.forward_mps() - 1.57).abs() < 0.05);
    bench.run(10.0);
    assert_close(bench.velocity_mps(), [0.0; 3], 1e-3);
    let before_m = bench.position_m();
    bench.run(600.0);
    assert_close(bench.position_m(), before_m, 1e-3);
}

/// A robot on its side does not roll, however fast its wheels turn.
#[test]
fn wheels_of_a_fallen_robot_are_ignored() {
    let mut bench = Bench::on_wheels();
    let half = core::f32::consts::FRAC_1_SQRT_2;
    bench.pose.orientation = Quaternion {
        w: half,
        x: half,
        y: 0.0,
        z: 0.0,
    };
    bench.accel_mps2 = [0.0, GRAVITY_MPS2, 0.0];
    bench.wheels_run([1.0, 1.0]);
    bench.run(5.0);
    assert_close(bench.velocity_mps(), [0.0; 3], 1e-3);
}

/// After half a second e⁻¹ of the speed is left, over 0.5 · 0.5 · (1 − e⁻¹) m.
#[test]
fn the_velocity_decays_while_the_imu_is_silent() {
    let mut bench = Bench::on_wheels();
    bench.drive(0.0, 0.5, 0.2);
    let [before_m, ..] = bench.position_m();
    for _ in 0..500 {
        bench.motion.decay(0.001);
    }
    let [after_m, ..] = bench.position_m();
    assert!((bench.forward_mps() - 0.184).abs() < 0.01);
    assert!((after_m - before_m - 0.158).abs() < 0.01);
}

/// 100 km in steps of 1 mm. A plain single-precision sum would be kilometres off.
#[test]
fn small_steps_are_not_lost_in_a_large_position() {
    let mut position = Position::new();
    let mut exact_m = 0.0;
    for _ in 0..100_000_000 {
        position.add([1e-3, 0.0, 0.0]);
        exact_m += f64::from(1e-3_f32);
    }
    let [x, ..] = position.total_m();
    assert!((f64::from(x) - exact_m).abs() < 0.01, "{x}");
}

/// Settings that are not numbers, and the largest values that a sensor may give.
#[test]
fn extreme_inputs_leave_no_trace() {
    for odd in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, 1e20] {
        let mut bench = Bench::on_wheels();
        let default = WheelOdomConfig::default();
        for config in [
            WheelOdomConfig {
                wheel_radius_m: odd,
                ..default
            },
            WheelOdomConfig {
                wheel_track_m: odd,
                ..default
            },
            WheelOdomConfig {
                gear_ratio: 1.0 / odd,
                ..default
            },
            default,
        ] {
            bench.motion.set_config(&config);
            bench.accel_mps2 = [300.0, -300.0, 300.0];
            bench.pose.rate_rps = [-40.0, 40.0, 40.0];
            bench.wheels_run([10.0, -10.0]);
            bench.run(0.5);
            let all = [
                bench.velocity_mps(),
                bench.position_m(),
                bench.motion.accel_bias_mps2(),
                bench.motion.kinematic_mps2(),
            ];
            assert!(
                all.as_flattened().iter().all(|x| x.abs() < 500.0),
                "{all:?}"
            );
        }
        bench.accel_mps2 = [0.0, 0.0, GRAVITY_MPS2];
        bench.pose.rate_rps = [0.0; 3];
        bench.wheels_run([0.0, 0.0]);
        bench.run(8.0);
        assert_close(bench.velocity_mps(), [0.0; 3], 1e-3);
        assert_close(bench.motion.accel_bias_mps2(), [0.0; 3], 1e-2);
    }
}
