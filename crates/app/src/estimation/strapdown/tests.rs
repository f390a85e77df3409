//! Rotations worked out by hand, and coning motion with rates in closed form.

use super::*;
use crate::math::testing::{rotation_of, to_f32};
use core::f32::consts::FRAC_PI_2;
use robot_test_support::Rotation;

fn assert_near(got: Vector3, expected: Vector3, limit: f32) {
    for (got, expected) in got.iter().zip(expected) {
        assert!((got - expected).abs() < limit, "{got}, not {expected}");
    }
}

fn angle_deg(strapdown: &Strapdown, truth: Rotation) -> f64 {
    rotation_of(strapdown.attitude).angle_to_deg(truth)
}

#[test]
fn a_quarter_turn_to_the_left_in_a_second() {
    let mut strapdown = Strapdown::new();
    for _ in 0..200 {
        strapdown.integrate_rate([0.0, 0.0, FRAC_PI_2], 0.005);
    }
    let left = Rotation::by([0.0, 0.0, std::f64::consts::FRAC_PI_2]);
    assert!(angle_deg(&strapdown, left) < 1e-3);
    // Extrapolated by 0.1 s forward and back.
    let ahead = rotation_of(strapdown.attitude_at(0.1));
    assert!(ahead.angle_to_deg(Rotation::by([0.0, 0.0, 99_f64.to_radians()])) < 1e-3);
    let back = rotation_of(strapdown.attitude_at(-0.1));
    assert!(back.angle_to_deg(Rotation::by([0.0, 0.0, 81_f64.to_radians()])) < 1e-3);
}

/// First about x, then about the body's own y.
#[test]
fn rotations_are_about_the_axes_of_the_body() {
    let mut strapdown = Strapdown::new();
    for rate in [[FRAC_PI_2, 0.0, 0.0], [0.0, FRAC_PI_2, 0.0]] {
        // One sample at rest in between keeps the coning correction out.
        strapdown.integrate_rate([0.0; 3], 0.005);
        for _ in 0..200 {
            strapdown.integrate_rate(rate, 0.005);
        }
    }
    // The first rotation lays the body's down axis to the left, the second moves forward to it.
    let rows = strapdown.attitude.rotation_matrix();
    let forward = rows.map(|[x, _, _]| x);
    assert_near(forward, [0.0, 1.0, 0.0], 1e-4);
}

#[test]
fn the_middle_of_a_sample_is_half_the_rotation() {
    let mut strapdown = Strapdown::new();
    let mid_sample = strapdown.integrate_rate([0.0, 0.0, 20.0], 0.005);
    // 0.1 rad in all.
    let [[cos, minus_sin, _], ..] = mid_sample.rotation;
    assert!((cos - 0.05_f32.cos()).abs() < 1e-6 && (minus_sin + 0.05_f32.sin()).abs() < 1e-6);
    assert_eq!(mid_sample.gap_error_rad2, 0.0);
}

#[test]
fn the_gyro_model_subtracts_bias_and_misalignment() {
    let gyro = GyroModel {
        bias_rps: [0.1, -0.2, 0.3],
        misalignment: [[0.01, 0.02, 0.0], [0.0, -0.01, 0.03], [0.04, 0.0, 0.02]],
    };
    // x: 1 − 0.1 − (0.01·1 + 0.02·2); y: 2 + 0.2 − (−0.01·2 + 0.03·3); z: 3 − 0.3 − (0.04·1 + 0.02·3).
    assert_near(gyro.corrected([1.0, 2.0, 3.0]), [0.85, 2.13, 2.6], 1e-6);
    let mut strapdown = Strapdown::new();
    strapdown.gyro = gyro;
    strapdown.integrate_rate([1.0, 2.0, 3.0], 0.005);
    assert_near(strapdown.rate_rps, [0.85, 2.13, 2.6], 1e-6);
}

/// The body's x axis draws a cone of half-angle `a`. The attitude is exp(a·(cos wt, sin wt, 0)), the rate in body axes
/// (−w·sin a·sin wt, w·sin a·cos wt, −w·(1 − cos a)).
fn cone_drift_deg(half_angle_deg: f64, frequency_hz: f64) -> f64 {
    let (a, w) = (
        half_angle_deg.to_radians(),
        frequency_hz * std::f64::consts::TAU,
    );
    let attitude = |t: f64| Rotation::by([a * (w * t).cos(), a * (w * t).sin(), 0.0]);
    let mut strapdown = Strapdown::new();
    strapdown.attitude = Quaternion::from_rotation([a as f32, 0.0, 0.0]);
    let dt = 0.005;
    let samples = 12_000;
    for sample in 0..samples {
        let (from, to) = (f64::from(sample) * dt, f64::from(sample + 1) * dt);
        let mean_rps = [
            a.sin() * ((w * to).cos() - (w * from).cos()) / dt,
            a.sin() * ((w * to).sin() - (w * from).sin()) / dt,
            -w * (1.0 - a.cos()),
        ];
        strapdown.integrate_rate(to_f32(mean_rps), 0.005);
    }
    angle_deg(&strapdown, attitude(f64::from(samples) * dt))
}

/// Without the coning correction a cone of 5° at 5 Hz drifts by 1.8° in a minute.
#[test]
fn coning_motion_does_not_drift() {
    for (half_angle_deg, frequency_hz) in [(5.0, 5.0), (2.0, 10.0), (20.0, 1.0)] {
        let drift_deg = cone_drift_deg(half_angle_deg, frequency_hz);
        println!("{half_angle_deg}° at {frequency_hz} Hz: {drift_deg:.4}° in a minute");
        assert!(drift_deg < 0.1, "{drift_deg}");
    }
}

/// A rate that grows evenly is bridged exactly: 1 rad/s in the last sample, then 35 ms without a sample, then one whose
/// middle is 40 ms later.
#[test]
fn a_gap_is_bridged_by_linear_interpolation() {
    let growth_rps2 = 10.0;
    let mut strapdown = Strapdown::new();
    strapdown.integrate_rate([0.0, 0.0, 1.0], 0.005);
    let before = rotation_of(strapdown.attitude);
    let mid_sample = strapdown.integrate_rate([0.0, 0.0, 1.0 + growth_rps2 * 0.040], 0.040);
    // From the end of the first sample, 2.5 ms after its middle, the rate grows from 1.025 rad/s for 40 ms.
    let turned = 1.025 * 0.040 + 0.5 * f64::from(growth_rps2) * 0.040 * 0.040;
    let [_, _, z] = before.to(rotation_of(strapdown.attitude));
    assert!((z - turned).abs() < 1e-6, "{z}, not {turned}");
    // The interpolated part: half the change of 0.4 rad/s over 35 ms, 7 mrad.
    assert!((mid_sample.gap_error_rad2 - 0.007 * 0.007).abs() < 1e-8);
}

#[test]
fn a_late_sample_is_no_gap() {
    let mut strapdown = Strapdown::new();
    strapdown.integrate_rate([0.0, 0.0, 1.0], 0.005);
    let before = rotation_of(strapdown.attitude);
    let mid_sample = strapdown.integrate_rate([0.0, 0.0, 2.0], 0.007);
    let [_, _, z] = before.to(rotation_of(strapdown.attitude));
    assert!((z - 0.014).abs() < 1e-6 && mid_sample.gap_error_rad2 == 0.0);
}

#[test]
fn the_velocity_is_integrated_and_decays() {
    let mut strapdown = Strapdown::new();
    for _ in 0..20 {
        strapdown.integrate_force([2.0, -1.0, 9.8], 0.005);
    }
    // 1.25 % decay in 0.1 s.
    let [east, north] = strapdown.speed_mps;
    assert!((east - 0.2).abs() < 0.004 && (north + 0.1).abs() < 0.002);
    for _ in 0..800 {
        strapdown.integrate_force([0.0, 0.0, 9.8], 0.005);
    }
    // After the time constant 1/e is left.
    let left = strapdown.speed_mps[0] / east;
    assert!((left - (-1.0_f32).exp()).abs() < 0.003, "{left}");
}

#[test]
fn the_world_rotates_about_its_own_axes() {
    let mut strapdown = Strapdown::new();
    // The nose points north: forward is the world's y axis.
    strapdown.attitude = Quaternion::from_rotation([0.0, 0.0, FRAC_PI_2]);
    strapdown.rotate_world([0.1, 0.0, 0.0]);
    let forward = strapdown.attitude.rotation_matrix().map(|[x, _, _]| x);
    assert_near(forward, [0.0, 0.1_f32.cos(), 0.1_f32.sin()], 1e-5);
}
