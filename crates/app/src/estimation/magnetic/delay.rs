//! How late the magnetometer is, beyond what its time stamps say.
//!
//! A field that is measured late by τ and turned into the world by an attitude that is τ too new is off by τ·ω × field.
//! While the robot turns this shows τ; a Kalman filter with one state learns it.

use crate::math::{Vector3, scalar, vector};

const FIRST_VARIANCE_S2: f32 = 0.01 * 0.01;
const MAX_DELAY_S: f32 = 0.05;
/// Of one sample: 1.5 µT that last for a second, at 50 Hz.
const NOISE_UT2: f32 = 1.5 * 1.5 * 50.0;
/// Further off it is another field, not a late one.
const MAX_RESIDUAL_UT: f32 = 15.0;
/// The mean field follows in so many samples.
const MEAN_SAMPLES: u16 = 1_000;
const FIRST_SAMPLES: u16 = 50;

#[derive(Clone, Debug)]
pub(super) struct Delay {
    seconds: f32,
    variance_s2: f32,
    mean_enu_ut: Vector3,
    samples: u16,
}

impl Delay {
    pub const fn new() -> Self {
        Self {
            seconds: 0.0,
            variance_s2: FIRST_VARIANCE_S2,
            mean_enu_ut: [0.0; 3],
            samples: 0,
        }
    }

    pub const fn seconds(&self) -> f32 {
        self.seconds
    }

    /// Field and rate of turn in ENU, the field turned there by the attitude of `seconds` ago.
    pub fn learn(&mut self, field_ut: Vector3, rate_rps: Vector3) {
        let residual = vector::sub(field_ut, self.mean_enu_ut);
        if self.samples > FIRST_SAMPLES && vector::is_within(residual, MAX_RESIDUAL_UT) {
            let slope = vector::cross(rate_rps, self.mean_enu_ut);
            let gain =
                self.variance_s2 / (self.variance_s2 * vector::dot(slope, slope) + NOISE_UT2);
            let found = self.seconds + gain * vector::dot(slope, residual);
            self.seconds = scalar::clamp(found, 0.0, MAX_DELAY_S);
            self.variance_s2 *= 1.0 - gain * vector::dot(slope, slope);
        }
        if self.samples < MEAN_SAMPLES {
            self.samples = self.samples.saturating_add(1);
        }
        let share = 1.0 / f32::from(self.samples);
        self.mean_enu_ut = vector::add(self.mean_enu_ut, vector::scale(residual, share));
    }

    /// The world turns under the robot by a rotation vector in ENU.
    pub fn tilt(&mut self, by_rad: Vector3) {
        let field = self.mean_enu_ut;
        self.mean_enu_ut = vector::add(field, vector::cross(by_rad, field));
    }

    /// Another north: the mean starts anew.
    pub fn forget_mean(&mut self) {
        self.mean_enu_ut = [0.0; 3];
        self.samples = 0;
    }
}

#[cfg(test)]
mod tests;
