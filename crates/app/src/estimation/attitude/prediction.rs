//! The prediction step over one window: P ← F P Fᵀ + Q, in small steps.
//!
//! Over a window of T seconds with mean specific force a, the errors of angle θ, velocity v and gyro parameters p
//! propagate as
//!
//! θ ← θ + Φ·p, v ← κ·v + C·(θ + Φ·p/2), C·θ = T·θ × a
//!
//! where only the level parts of v are kept. Φ is [`Window::angle_jacobian`], κ the decay of the velocity. These lines are
//! applied to the rows of P and then to its columns.

use super::{
    covariance::Covariance,
    error_state::{self, BIAS, ErrorVector, GyroParameters, gyro_parameters},
    window::Window,
};
use crate::{
    estimation::strapdown::SPEED_TIME_CONSTANT_S,
    math::{Vector3, vector},
};

const DEG: f32 = 1.0_f32.to_radians();
/// White noise of the angular rate, which stands for what the model leaves out: (0.15 °/√s)².
const ANGLE_NOISE_DENSITY: f32 = (0.15 * DEG) * (0.15 * DEG);
/// Noise that grows with the rotation, because gyros are not quite linear: (2·10⁻⁴ rad)² per rad²/s.
const ANGLE_NOISE_PER_RATE2: f32 = 0.0002 * 0.0002;
/// Random walk of the gyro bias: (0.0045 °/s)² per second.
const BIAS_NOISE_DENSITY: f32 = (0.0045 * DEG) * (0.0045 * DEG);
/// Acceleration that may be missed while the accelerometer is saturated, m/s².
const CLIPPED_ACCEL_MPS2: f32 = 200.0;

/// What the prediction needs of a window that has ended.
#[derive(Clone, Debug, Default)]
pub(super) struct Prediction {
    /// Φ.
    angle_jacobian: [GyroParameters; 3],
    /// C = ∂v/∂θ.
    speed_jacobian: [Vector3; 2],
    /// κ.
    speed_decay: f32,
    /// Process noise of each angle, rad².
    angle_noise: f32,
    /// Process noise of the velocity, (m/s)².
    speed_noise: f32,
    /// Process noise of the gyro bias, (rad/s)².
    bias_noise: f32,
    /// Covariance of Φ·p with all states.
    rotation_covariance: [ErrorVector; 3],
}

impl Prediction {
    /// Takes F and Q from the window.
    pub fn begin(&mut self, window: &Window) {
        let t = window.duration_s;
        let [ax, ay, az] = vector::scale(window.accel_mps2(), t);
        let clipped_mps = CLIPPED_ACCEL_MPS2 * window.accel_clipped_s;
        let decayed = t / SPEED_TIME_CONSTANT_S;
        self.angle_jacobian = window.angle_jacobian;
        self.speed_jacobian = [[0.0, az, -ay], [-az, 0.0, ax]];
        self.speed_decay = 1.0 - decayed + 0.5 * decayed * decayed;
        self.angle_noise = ANGLE_NOISE_DENSITY * t
            + ANGLE_NOISE_PER_RATE2 * window.squared_rate_integral
            + window.gap_error_rad2;
        self.speed_noise = clipped_mps * clipped_mps;
        self.bias_noise = BIAS_NOISE_DENSITY * t;
    }

    /// Computes the covariance of Φ·p about one axis of ENU with all states.
    pub fn correlate_rotation(&mut self, axis: usize, covariance: &Covariance) {
        let jacobian = self.angle_jacobian.get(axis);
        if let (Some(jacobian), Some(found)) = (jacobian, self.rotation_covariance.get_mut(axis)) {
            for (to, row) in found.iter_mut().zip(&covariance.rows) {
                *to = error_state::dot(jacobian, gyro_parameters(row));
            }
        }
    }

    /// P ← F P.
    pub fn propagate_rows(&self, covariance: &mut Covariance) {
        self.add_half_rotation(covariance);
        let [x, y, z, speeds @ ..] = &mut covariance.rows;
        for (speed, jacobian) in speeds.iter_mut().zip(&self.speed_jacobian) {
            let before = *speed;
            error_state::add_scaled(speed, self.speed_decay - 1.0, &before);
            for (angle, factor) in [&*x, y, z].into_iter().zip(jacobian) {
                error_state::add_scaled(speed, *factor, angle);
            }
        }
        self.add_half_rotation(covariance);
    }

    #[inline(never)]
    fn add_half_rotation(&self, covariance: &mut Covariance) {
        for (angle, rotation) in covariance.rows.iter_mut().zip(&self.rotation_covariance) {
            error_state::add_scaled(angle, 0.5, rotation);
        }
    }

    /// P ← P Fᵀ, the rows of angles and velocity.
    pub fn propagate_columns(&self, covariance: &mut Covariance) {
        for row in covariance.rows.iter_mut().take(BIAS) {
            let rotated = self
                .angle_jacobian
                .each_ref()
                .map(|jacobian| error_state::dot(jacobian, gyro_parameters(row)));
            let [x, y, z, east, north, ..] = row;
            let half = vector::scale(rotated, 0.5);
            let angles = vector::add([*x, *y, *z], half);
            let [by_east, by_north] = self.speed_jacobian;
            *east = self.speed_decay * *east + vector::dot(by_east, angles);
            *north = self.speed_decay * *north + vector::dot(by_north, angles);
            [*x, *y, *z] = vector::add(angles, half);
        }
    }

    /// P ← P + Q.
    pub fn add_process_noise(&self, covariance: &mut Covariance) {
        covariance.symmetrise();
        let (angle, speed) = (self.angle_noise, self.speed_noise);
        covariance.add_variances(0, &[angle, angle, angle, speed, speed]);
        covariance.add_bias_noise(self.bias_noise);
    }
}
