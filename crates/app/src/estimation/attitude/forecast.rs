//! How the errors grow over one window, in small pieces of work.
//!
//! Over a window of T seconds with mean specific force a the errors of angle θ, speed v and gyro parameters p go
//!
//! θ ← θ + Φ·p, v ← v + T·θ × a + T/2·(Φ·p) × a
//!
//! (only the level parts of v). Φ is [`Window::turn_by_parameter`]. With F the matrix of these lines the covariance goes
//! P ← F·P·Fᵀ + Q; here block by block.

use super::{
    covariance::{Covariance, FAST, Fast, add_scaled, dot},
    strapdown::SPEED_MEMORY_S,
    window::{PARAMETERS, Parameters, Window},
};
use crate::math::{Vector3, scalar};

const DEG: f32 = 1.0_f32.to_radians();
/// What the model leaves out turns the attitude like white noise: 0.15 °/√s …
const TURN_DENSITY: f32 = (0.15 * DEG) * (0.15 * DEG);
/// … and more while turning, rad per √rad of it: gyros are not quite linear.
const TURN_SHARE: f32 = 0.0002 * 0.0002;
/// The gyro bias wanders by 0.0045 °/s in a second, as a random walk.
const BIAS_DENSITY: f32 = (0.0045 * DEG) * (0.0045 * DEG);
/// Largest uncertainty that wandering alone leads to.
const MAX_BIAS_VARIANCE: f32 = (3.0 * DEG) * (3.0 * DEG);
/// Acceleration that may go unseen while the accelerometer is beyond its range, m/s².
const BLIND_ACCEL_MPS2: f32 = 200.0;
/// Below this a variance has no meaning in single precision.
const LEAST_VARIANCE: f32 = 1e-12;

/// What the forecast needs of a window that is over.
#[derive(Clone, Debug)]
pub(super) struct Forecast {
    /// θ (rows 0–2), then v east and north, by parameter.
    by_parameter: [Parameters; FAST],
    /// v east and north by angle: T·(θ × a).
    speed_by_angle: [Vector3; 2],
    /// Share of the speed that is left after the window.
    kept: f32,
    noise: Fast,
    bias_noise: f32,
    /// Φ·P of the slow block, as far as it is done; then of speed too.
    gain: [Parameters; FAST],
    /// Covariance of the fast errors after with those before.
    half_done: [Fast; FAST],
}

impl Forecast {
    pub fn new(window: &Window) -> Self {
        let t = window.duration_s;
        let [ax, ay, az] = window.accel_mps2();
        let [east, north, up] = window.turn_by_parameter;
        let speed_by_angle = [[0.0, az * t, -ay * t], [-az * t, 0.0, ax * t]];
        let [mut east_mps, mut north_mps] = [[0.0; PARAMETERS]; 2];
        for (row, weights) in [&mut east_mps, &mut north_mps]
            .into_iter()
            .zip(speed_by_angle)
        {
            for (angle, weight) in [&east, &north, &up].into_iter().zip(weights) {
                add_scaled(row, 0.5 * weight, angle);
            }
        }
        let turn = TURN_DENSITY * t + TURN_SHARE * window.turned_rad2_per_s + window.unseen_rad2;
        let blind_mps = BLIND_ACCEL_MPS2 * window.blind_s;
        let speed = blind_mps * blind_mps;
        Self {
            by_parameter: [east, north, up, east_mps, north_mps],
            speed_by_angle,
            kept: 1.0 - t / SPEED_MEMORY_S + 0.5 * (t / SPEED_MEMORY_S) * (t / SPEED_MEMORY_S),
            noise: [turn, turn, turn, speed, speed],
            bias_noise: BIAS_DENSITY * t,
            gain: [[0.0; PARAMETERS]; FAST],
            half_done: [[0.0; FAST]; FAST],
        }
    }

    /// Φ·P for one axis of ENU. Work for one sample.
    pub fn turn_axis(&mut self, axis: usize, covariance: &Covariance) {
        let (Some(by_parameter), Some(gain)) =
            (self.by_parameter.get(axis), self.gain.get_mut(axis))
        else {
            return;
        };
        for (weight, row) in by_parameter.iter().zip(&covariance.slow) {
            add_scaled(gain, *weight, row);
        }
    }

    /// F·P, first half: fast errors after with fast ones before.
    pub fn fast_forward(&mut self, covariance: &Covariance) {
        for ((half, fast), by_parameter) in self
            .half_done
            .iter_mut()
            .zip(&covariance.fast)
            .zip(&self.by_parameter)
        {
            *half = *fast;
            for (value, cross) in half.iter_mut().zip(&covariance.cross) {
                *value += dot(by_parameter, cross);
            }
        }
        let [_, _, _, speed @ ..] = &mut self.half_done;
        let [before_x, before_y, before_z, ..] = &covariance.fast;
        let [_, _, _, before_speed @ ..] = &covariance.fast;
        for ((row, [wx, wy, wz]), before) in
            speed.iter_mut().zip(self.speed_by_angle).zip(before_speed)
        {
            add_scaled(row, self.kept - 1.0, before);
            add_scaled(row, wx, before_x);
            add_scaled(row, wy, before_y);
            add_scaled(row, wz, before_z);
        }
        let [gx, gy, gz, gain_speed @ ..] = &mut self.gain;
        for (row, [wx, wy, wz]) in gain_speed.iter_mut().zip(self.speed_by_angle) {
            add_scaled(row, 0.5 * wx, gx);
            add_scaled(row, 0.5 * wy, gy);
            add_scaled(row, 0.5 * wz, gz);
        }
    }

    /// The cross block: F·P with the slow errors, which stay as they are.
    pub fn cross_forward(&self, covariance: &mut Covariance) {
        let [x, y, z, speed @ ..] = &mut covariance.cross;
        for (row, [wx, wy, wz]) in speed.iter_mut().zip(self.speed_by_angle) {
            for value in &mut *row {
                *value *= self.kept;
            }
            add_scaled(row, wx, x);
            add_scaled(row, wy, y);
            add_scaled(row, wz, z);
        }
        for (row, gain) in covariance.cross.iter_mut().zip(&self.gain) {
            add_scaled(row, 1.0, gain);
        }
    }

    /// … · Fᵀ + Q: the fast block, with the cross block already done; then noise on the slow block.
    pub fn finish(&self, covariance: &mut Covariance) {
        for ((row, half), cross) in covariance
            .fast
            .iter_mut()
            .zip(&self.half_done)
            .zip(&covariance.cross)
        {
            let [hx, hy, hz, ..] = half;
            *row = *half;
            let [.., east, north] = row;
            let [[ex, ey, ez], [nx, ny, nz]] = self.speed_by_angle;
            *east *= self.kept;
            *north *= self.kept;
            *east += ex * hx + ey * hy + ez * hz;
            *north += nx * hx + ny * hy + nz * hz;
            for (value, by_parameter) in row.iter_mut().zip(&self.by_parameter) {
                *value += dot(cross, by_parameter);
            }
        }
        covariance.even_out();
        for (index, (row, noise)) in covariance.fast.iter_mut().zip(self.noise).enumerate() {
            if let Some(variance) = row.get_mut(index) {
                *variance = scalar::max(*variance + noise, LEAST_VARIANCE);
            }
        }
        for (index, row) in covariance.slow.iter_mut().enumerate() {
            let Some(variance) = row.get_mut(index) else {
                continue;
            };
            if index < 3 && *variance < MAX_BIAS_VARIANCE {
                *variance += self.bias_noise;
            }
            *variance = scalar::max(*variance, LEAST_VARIANCE);
        }
    }
}
