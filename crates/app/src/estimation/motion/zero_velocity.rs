//! Detection of a standstill, for zero-velocity updates.

use crate::math::{Vector3, scalar, vector};

/// Quiet time that counts as a standstill while the wheels stand.
const STANDING_S: f32 = 0.3;
/// The same while no wheel reports. By then the velocity has already decayed.
const UNHEARD_S: f32 = 4.0;
/// Largest angular rate of a quiet sample (5.7 °/s). It leaves room for a gyro bias that is not known yet.
const MAX_RATE_RPS: f32 = 0.1;
/// Largest difference of its specific force from the smoothed one.
const MAX_CHANGE_MPS2: f32 = 0.3;
/// Time constant of the smoothed specific force.
const SMOOTHING_S: f32 = 0.2;
/// Largest free acceleration of a quiet sample, which bias and tilt error may explain. A robot that slides on locked
/// wheels decelerates more.
const MAX_FREE_MPS2: f32 = 1.0;

/// The wheels' evidence of a standstill.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum WheelEvidence {
    /// All wheels that report stand, and none slips.
    Standing,
    /// At least one wheel rolls.
    Turning,
    /// All wheels that turn slip.
    Spinning,
    /// No wheel reports.
    Silent,
}

/// Detects a standstill by wheels, gyro and accelerometer.
#[derive(Clone, Copy, Debug)]
pub(super) struct ZeroVelocityDetector {
    /// Smoothed specific force in body axes; `None` before the first sample.
    smooth_mps2: Option<Vector3>,
    quiet: bool,
    quiet_s: f32,
}

impl ZeroVelocityDetector {
    pub const fn new() -> Self {
        Self {
            smooth_mps2: None,
            quiet: false,
            quiet_s: 0.0,
        }
    }

    /// True if the last sample was quiet.
    pub const fn is_quiet(&self) -> bool {
        self.quiet
    }

    /// Takes a sample; returns true while the robot stands. `forces_mps2` are the specific force and the free acceleration
    /// (without gravity and bias), both in body axes. `stood` means that nothing but the wheels contradicts a standstill.
    pub fn detect(
        &mut self,
        forces_mps2: (Vector3, Vector3),
        rate_rps: Vector3,
        wheels: WheelEvidence,
        stood: bool,
        dt_s: f32,
    ) -> bool {
        self.quiet = self.is_quiet_sample(forces_mps2, rate_rps, dt_s);
        let needed_s = match wheels {
            WheelEvidence::Standing => STANDING_S,
            WheelEvidence::Silent => UNHEARD_S,
            WheelEvidence::Spinning => return stood && self.quiet,
            WheelEvidence::Turning => {
                self.quiet_s = 0.0;
                return false;
            }
        };
        self.quiet_s = if self.quiet { self.quiet_s + dt_s } else { 0.0 };
        self.quiet_s >= needed_s
    }

    fn is_quiet_sample(
        &mut self,
        (force_mps2, free_mps2): (Vector3, Vector3),
        rate_rps: Vector3,
        dt_s: f32,
    ) -> bool {
        let smooth_mps2 = self.smooth_mps2.unwrap_or(force_mps2);
        let change = vector::sub(force_mps2, smooth_mps2);
        let share = scalar::min(dt_s / SMOOTHING_S, 1.0);
        self.smooth_mps2 = Some(vector::add(smooth_mps2, vector::scale(change, share)));
        is_shorter(rate_rps, MAX_RATE_RPS)
            && is_shorter(change, MAX_CHANGE_MPS2)
            && is_shorter(free_mps2, MAX_FREE_MPS2)
    }
}

fn is_shorter(v: Vector3, limit: f32) -> bool {
    vector::dot(v, v) < limit * limit
}
