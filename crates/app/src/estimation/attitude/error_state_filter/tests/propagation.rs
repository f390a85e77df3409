//! Propagation of a correction through the next window, against two strapdown integrations that differ by that
//! correction.

use super::*;
use crate::estimation::strapdown::Strapdown;

/// An estimated and a true state that integrate the same sensors.
struct Pair {
    estimated: Strapdown,
    truth: Strapdown,
    window: Window,
    random: Random,
    rate_rps: [f64; 3],
}

impl Pair {
    /// `correction` turns the estimate into the truth.
    fn new(correction: &Correction) -> Self {
        let mut estimated = Strapdown::new();
        estimated.attitude = Quaternion::from_rotation([0.4, -0.3, 0.5]);
        let mut truth = estimated.clone();
        let [x, y, z, east, north, ..] = correction.errors;
        truth.rotate_world([x, y, z]);
        truth.speed_mps = [east, north];
        correction.apply_to(&mut truth.gyro);
        Self {
            estimated,
            truth,
            window: Window::new(),
            random: Random::new(3),
            rate_rps: [1.0, -2.0, 1.5],
        }
    }

    fn sample(&mut self) {
        let push = self.random.vector(0.2);
        self.rate_rps = std::array::from_fn(|axis| self.rate_rps[axis] + push[axis]);
        let gyro_rps = to_f32(self.rate_rps);
        let before = self.truth.integrate_rate(gyro_rps, DT_S);
        // The body accelerates, so that the force does not point up.
        let force_enu = [1.5, -2.0, 9.806_65];
        let middle = before.rotation;
        let accel_mps2: Vector3 =
            std::array::from_fn(|axis| (0..3).map(|row| middle[row][axis] * force_enu[row]).sum());
        let mid_sample = self.estimated.integrate_rate(gyro_rps, DT_S);
        self.window
            .add_rotation(&mid_sample, gyro_rps, self.estimated.rate_rps, DT_S);
        let force = mid_sample.rotation.map(|row| vector::dot(row, accel_mps2));
        self.window.add_accel(force);
        self.estimated.integrate_force(force, DT_S);
        self.truth.integrate_force(force_enu, DT_S);
    }
}

/// Compares the difference of the two after `samples` with the propagated correction.
fn compare(correction: &Correction, samples: usize, angle_limit: f64, speed_limit: f64) {
    let mut pair = Pair::new(correction);
    for _ in 0..samples {
        pair.sample();
    }
    let truth = rotation_of(pair.estimated.attitude).to(rotation_of(pair.truth.attitude));
    let (angle, speed) = correction.propagated_through(&pair.window);
    for axis in 0..3 {
        let off = f64::from(angle[axis]) - truth[axis];
        assert!(off.abs() < angle_limit, "angle {angle:?}, really {truth:?}");
    }
    for axis in 0..2 {
        let apart = pair.truth.speed_mps[axis] - pair.estimated.speed_mps[axis];
        let off = f64::from(speed[axis] - apart);
        assert!(off.abs() < speed_limit, "speed {speed:?} off by {off}");
    }
}

#[test]
fn an_attitude_error_becomes_a_velocity_error() {
    for axis in 0..3 {
        let mut correction = Correction::default();
        correction.errors[axis] = 0.01;
        // 0.01 rad of 9.8 m/s² for 80 ms: 8 mm/s.
        compare(&correction, 16, 2e-5, 3e-4);
    }
}

#[test]
fn a_velocity_error_stays() {
    let mut correction = Correction::default();
    correction.errors[SPEED] = 0.5;
    correction.errors[SPEED + 1] = -0.3;
    // 2 % of a velocity decay in 80 ms.
    compare(&correction, 16, 1e-6, 0.02 * 0.5);
}

#[test]
fn each_gyro_parameter_propagates_into_the_attitude() {
    for parameter in 0..GYRO_PARAMETERS {
        let mut correction = Correction::default();
        correction.errors[BIAS + parameter] = 0.01;
        // 0.01 rad/s for 80 ms are 8e-4 rad. The velocity that results from it, 3 mm/s, is not modelled.
        compare(&correction, 16, 3e-6 + 3e-5, 0.003 * 3.0);
    }
}
