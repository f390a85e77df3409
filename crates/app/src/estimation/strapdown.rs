//! Strapdown integration: attitude and velocity from gyro and accelerometer alone.

use crate::math::{Quaternion, Vector3, vector};

/// Nominal interval of one gyro sample. Whatever a longer gap adds to it was not measured.
const SAMPLE_S: f32 = 0.005;
/// An interval longer than this has samples missing.
const GAP_S: f32 = 0.007_5;

/// Time constant with which the integrated velocity decays, so that only its changes count.
pub(super) const SPEED_TIME_CONSTANT_S: f32 = 4.0;

/// The nominal state of the error-state filter.
#[derive(Clone, Debug)]
pub(super) struct Strapdown {
    /// Body → ENU.
    pub attitude: Quaternion,
    /// High-passed velocity east and north, m/s. Its mean over time is about zero.
    pub speed_mps: [f32; 2],
    pub gyro: GyroModel,
    /// Angular rate of the last sample in body axes, corrected by the gyro model.
    pub rate_rps: Vector3,
    /// Rotation vector of the last sample, for the coning correction.
    last_rotation_rad: Vector3,
}

/// Gyro error model: true rate = measured − bias − misalignment · measured.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct GyroModel {
    /// Body axes, rad/s.
    pub bias_rps: Vector3,
    /// Scale errors on the diagonal, angles between the axes (rad) beside it.
    pub misalignment: [Vector3; 3],
}

impl GyroModel {
    /// Applies the model to a measured rate.
    pub fn corrected(&self, gyro_rps: Vector3) -> Vector3 {
        let skew_rps = self.misalignment.map(|row| vector::dot(row, gyro_rps));
        vector::sub(vector::sub(gyro_rps, self.bias_rps), skew_rps)
    }
}

/// The attitude in the middle of a sample, where the mean specific force of the sample belongs.
#[derive(Clone, Copy, Debug)]
pub(super) struct MidSample {
    /// Rotation matrix body → ENU, by rows.
    pub rotation: [Vector3; 3],
    /// Variance of the angle that was interpolated across missing samples, rad².
    pub gap_error_rad2: f32,
}

impl Strapdown {
    pub fn new() -> Self {
        Self {
            attitude: Quaternion::IDENTITY,
            speed_mps: [0.0; 2],
            gyro: GyroModel::default(),
            rate_rps: [0.0; 3],
            last_rotation_rad: [0.0; 3],
        }
    }

    /// Rotates the attitude by one gyro sample. `gyro_rps` is the mean rate over the last `dt_s`. If samples are missing,
    /// it is the mean over the end of that interval.
    pub fn integrate_rate(&mut self, gyro_rps: Vector3, dt_s: f32) -> MidSample {
        let rate_rps = self.gyro.corrected(gyro_rps);
        let mut rotation_rad = vector::scale(rate_rps, dt_s);
        let mut gap_error_rad2 = 0.0;
        if dt_s > GAP_S {
            // The rate across the gap is interpolated linearly.
            let interpolated_rad = vector::scale(
                vector::sub(self.rate_rps, rate_rps),
                0.5 * (dt_s - SAMPLE_S),
            );
            rotation_rad = vector::add(rotation_rad, interpolated_rad);
            gap_error_rad2 = vector::dot(interpolated_rad, interpolated_rad);
        } else {
            // The rotation axis moves within a sample (coning): two-sample correction (Savage, 1998).
            let coning = vector::cross(self.last_rotation_rad, rotation_rad);
            rotation_rad = vector::add(rotation_rad, vector::scale(coning, 1.0 / 12.0));
        }
        self.rate_rps = rate_rps;
        self.last_rotation_rad = rotation_rad;
        let half = Quaternion::from_rotation(vector::scale(rotation_rad, 0.5));
        let middle = self.attitude.after(half);
        self.attitude = middle.after(half).renormalised();
        MidSample {
            rotation: middle.rotation_matrix(),
            gap_error_rad2,
        }
    }

    /// Integrates the level part of a specific force in ENU, the mean over the last `dt_s`. Gravity has no level part.
    pub fn integrate_force(&mut self, [east, north, _]: Vector3, dt_s: f32) {
        let kept = 1.0 - dt_s / SPEED_TIME_CONSTANT_S;
        let [vx, vy] = self.speed_mps;
        self.speed_mps = [kept * vx + east * dt_s, kept * vy + north * dt_s];
    }

    /// The attitude `ahead_s` after the last sample (before it if negative), extrapolated with the last rate.
    pub fn attitude_at(&self, ahead_s: f32) -> Quaternion {
        let rotation_rad = vector::scale(self.rate_rps, ahead_s);
        self.attitude.after(Quaternion::from_rotation(rotation_rad))
    }

    /// Corrects the attitude by a rotation vector in ENU: q ← exp(θ) q.
    pub fn rotate_world(&mut self, by_rad: Vector3) {
        self.attitude = Quaternion::from_rotation(by_rad)
            .after(self.attitude)
            .normalised();
    }
}

#[cfg(test)]
mod tests;
