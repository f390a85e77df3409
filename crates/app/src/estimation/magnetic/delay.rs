//! The delay of the magnetometer beyond its time stamps.
//!
//! A field that was measured τ too late and is rotated to ENU by the attitude at its time stamp is off by τ·ω × m. While
//! the robot rotates, this shows τ. A Kalman filter with one state estimates it.

use crate::math::{Vector3, scalar, vector};

/// Initial variance, (10 ms)².
const INITIAL_VARIANCE_S2: f32 = 0.01 * 0.01;
const MAX_DELAY_S: f32 = 0.05;
/// Measurement noise of one sample at 50 Hz: 1.5 µT that last for one second.
const NOISE_UT2: f32 = 1.5 * 1.5 * 50.0;
/// A larger innovation is a disturbance, not a delay.
const MAX_INNOVATION_UT: f32 = 15.0;
/// Time constant of the reference field, in samples.
const REFERENCE_SAMPLES: u16 = 1_000;
/// Samples in the reference field before it is used.
const MIN_SAMPLES: u16 = 50;

/// Estimates the delay.
#[derive(Clone, Debug)]
pub(super) struct DelayFilter {
    seconds: f32,
    variance_s2: f32,
    /// Mean field in ENU.
    reference_ut: Vector3,
    samples: u16,
}

impl DelayFilter {
    pub const fn new() -> Self {
        Self {
            seconds: 0.0,
            variance_s2: INITIAL_VARIANCE_S2,
            reference_ut: [0.0; 3],
            samples: 0,
        }
    }

    /// The estimated delay, 0 … 50 ms.
    pub const fn seconds(&self) -> f32 {
        self.seconds
    }

    /// Updates the filter with a sample in ENU, rotated there by the attitude of [`Self::seconds`] before its time stamp.
    /// `rate_rps` is the angular rate in ENU.
    pub fn update(&mut self, field_ut: Vector3, rate_rps: Vector3) {
        let innovation = vector::sub(field_ut, self.reference_ut);
        if self.samples > MIN_SAMPLES && vector::is_within(innovation, MAX_INNOVATION_UT) {
            let jacobian = vector::cross(rate_rps, self.reference_ut);
            let gain =
                self.variance_s2 / (self.variance_s2 * vector::dot(jacobian, jacobian) + NOISE_UT2);
            let found = self.seconds + gain * vector::dot(jacobian, innovation);
            self.seconds = scalar::clamp(found, 0.0, MAX_DELAY_S);
            self.variance_s2 *= 1.0 - gain * vector::dot(jacobian, jacobian);
        }
        if self.samples < REFERENCE_SAMPLES {
            self.samples = self.samples.saturating_add(1);
        }
        let share = 1.0 / f32::from(self.samples);
        self.reference_ut = vector::add(self.reference_ut, vector::scale(innovation, share));
    }

    /// Rotates the reference field by a rotation vector in ENU, as the attitude was.
    pub fn rotate_world(&mut self, by_rad: Vector3) {
        let field = self.reference_ut;
        self.reference_ut = vector::add(field, vector::cross(by_rad, field));
    }

    /// Drops the reference field, after the heading has jumped.
    pub fn reset_reference(&mut self) {
        self.reference_ut = [0.0; 3];
        self.samples = 0;
    }
}

#[cfg(test)]
mod tests;
