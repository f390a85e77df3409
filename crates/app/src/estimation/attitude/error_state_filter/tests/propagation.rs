//! A correction that was found some samples ago, against two strapdown integrations that differ by it.

use super::*;
use crate::estimation::strapdown::Strapdown;

/// What the filter believes, and the truth: both see the same sensors.
struct Twins {
    believed: Strapdown,
    real: Strapdown,
    window: Window,
    random: Random,
    rate_rps: [f64; 3],
}

impl Twins {
    /// `correction` turns what is believed into the truth.
    fn new(correction: &Correction) -> Self {
        let mut believed = Strapdown::new();
        believed.attitude = Quaternion::from_rotation([0.4, -0.3, 0.5]);
        let mut real = believed.clone();
        let [x, y, z, east, north, ..] = correction.errors;
        real.rotate_world([x, y, z]);
        real.speed_mps = [east, north];
        correction.apply_to(&mut real.gyro);
        Self {
            believed,
            real,
            window: Window::new(),
            random: Random::new(3),
            rate_rps: [1.0, -2.0, 1.5],
        }
    }

    fn sample(&mut self) {
        let push = self.random.normals(0.2);
        self.rate_rps = std::array::from_fn(|axis| self.rate_rps[axis] + push[axis]);
        let gyro_rps = to_f32(self.rate_rps);
        let before = self.real.integrate_rate(gyro_rps, DT_S);
        // The body is pushed about, so that the force is not upright.
        let force_enu = [1.5, -2.0, 9.806_65];
        let middle = before.rotation;
        let accel_mps2: Vector3 =
            std::array::from_fn(|axis| (0..3).map(|row| middle[row][axis] * force_enu[row]).sum());
        let mid_sample = self.believed.integrate_rate(gyro_rps, DT_S);
        self.window
            .add_rotation(&mid_sample, gyro_rps, self.believed.rate_rps, DT_S);
        let felt = mid_sample.rotation.map(|row| vector::dot(row, accel_mps2));
        self.window.add_accel(felt);
        self.believed.integrate_force(felt, DT_S);
        self.real.integrate_force(force_enu, DT_S);
    }
}

/// How far apart they are after `samples`, and what the filter says.
fn compare(correction: &Correction, samples: usize, angle_limit: f64, speed_limit: f64) {
    let mut twins = Twins::new(correction);
    for _ in 0..samples {
        twins.sample();
    }
    let real = Rotation::of(twins.believed.attitude).to(Rotation::of(twins.real.attitude));
    let (angle, speed) = correction.propagated_through(&twins.window);
    for axis in 0..3 {
        let off = f64::from(angle[axis]) - real[axis];
        assert!(off.abs() < angle_limit, "angle {angle:?}, really {real:?}");
    }
    for axis in 0..2 {
        let apart = twins.real.speed_mps[axis] - twins.believed.speed_mps[axis];
        let off = f64::from(speed[axis] - apart);
        assert!(off.abs() < speed_limit, "speed {speed:?} off by {off}");
    }
}

#[test]
fn a_wrong_attitude_gains_speed_sideways() {
    for axis in 0..3 {
        let mut correction = Correction::default();
        correction.errors[axis] = 0.01;
        // 0.01 rad of 9.8 m/s² for 80 ms: 8 mm/s.
        compare(&correction, 16, 2e-5, 3e-4);
    }
}

#[test]
fn a_speed_stays() {
    let mut correction = Correction::default();
    correction.errors[SPEED] = 0.5;
    correction.errors[SPEED + 1] = -0.3;
    // Of a speed 2 % are forgotten in 80 ms.
    compare(&correction, 16, 1e-6, 0.02 * 0.5);
}

#[test]
fn each_parameter_of_the_gyro_turns_the_attitude_its_own_way() {
    for parameter in 0..GYRO_PARAMETERS {
        let mut correction = Correction::default();
        correction.errors[BIAS + parameter] = 0.01;
        // 0.01 rad/s for 80 ms: 8e-4 rad; the speed that this adds by then is left out, 3 mm/s.
        compare(&correction, 16, 3e-6 + 3e-5, 0.003 * 3.0);
    }
}
