//! Attitude and speed from gyro and accelerometer alone (strapdown integration).

use crate::math::{Quaternion, Vector3, vector};

/// A sample lasts so long; what a longer gap adds was not measured.
const SAMPLE_S: f32 = 0.005;
/// Gaps longer than this have samples missing.
const GAP_S: f32 = 0.007_5;

/// A speed is forgotten in this time: only changes of it are felt.
pub(super) const SPEED_MEMORY_S: f32 = 4.0;

/// What is believed now.
#[derive(Clone, Debug)]
pub(in crate::estimation) struct Strapdown {
    /// Body → ENU.
    pub attitude: Quaternion,
    /// East and north, as felt: about zero in the mean over time.
    pub speed_mps: [f32; 2],
    pub gyro: GyroModel,
    /// Without errors, of the last sample.
    pub rate_rps: Vector3,
    last_turn_rad: Vector3,
}

/// true rate = measured − bias − misalignment · measured.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::estimation) struct GyroModel {
    pub bias_rps: Vector3,
    /// Scale errors on the diagonal, angles between the axes beside it.
    pub misalignment: [Vector3; 3],
}

impl GyroModel {
    pub fn corrected(&self, gyro_rps: Vector3) -> Vector3 {
        let skew_rps = self.misalignment.map(|row| vector::dot(row, gyro_rps));
        vector::sub(vector::sub(gyro_rps, self.bias_rps), skew_rps)
    }
}

/// One sample carried into the world.
#[derive(Clone, Copy, Debug)]
pub(in crate::estimation) struct Carried {
    /// Rows of body → ENU in the middle of the sample.
    pub middle: [Vector3; 3],
    /// Square of the angle that no gyro sample covers, rad².
    pub unseen_rad2: f32,
}

impl Strapdown {
    pub fn new() -> Self {
        Self {
            attitude: Quaternion::IDENTITY,
            speed_mps: [0.0; 2],
            gyro: GyroModel::default(),
            rate_rps: [0.0; 3],
            last_turn_rad: [0.0; 3],
        }
    }

    /// `gyro_rps`: mean over the `dt_s` before now, or over their end if samples are missing.
    pub fn turn(&mut self, gyro_rps: Vector3, dt_s: f32) -> Carried {
        let rate_rps = self.gyro.corrected(gyro_rps);
        let mut turn_rad = vector::scale(rate_rps, dt_s);
        let mut unseen_rad2 = 0.0;
        if dt_s > GAP_S {
            // In between the rate went from the last one to this.
            let less = vector::scale(
                vector::sub(self.rate_rps, rate_rps),
                0.5 * (dt_s - SAMPLE_S),
            );
            turn_rad = vector::add(turn_rad, less);
            unseen_rad2 = vector::dot(less, less);
        } else {
            // The axis moves within a sample (coning): two-sample correction of Savage, 1998.
            let coning = vector::cross(self.last_turn_rad, turn_rad);
            turn_rad = vector::add(turn_rad, vector::scale(coning, 1.0 / 12.0));
        }
        self.rate_rps = rate_rps;
        self.last_turn_rad = turn_rad;
        let half = Quaternion::from_rotation(vector::scale(turn_rad, 0.5));
        let middle = self.attitude.after(half);
        self.attitude = middle.after(half).renormalised();
        Carried {
            middle: middle.rotation_matrix(),
            unseen_rad2,
        }
    }

    /// Specific force in ENU, mean over the last `dt_s`. Its level parts count: gravity has none.
    pub fn accelerate(&mut self, [east, north, _]: Vector3, dt_s: f32) {
        let kept = 1.0 - dt_s / SPEED_MEMORY_S;
        let [vx, vy] = self.speed_mps;
        self.speed_mps = [kept * vx + east * dt_s, kept * vy + north * dt_s];
    }

    /// `ahead_s` after the last sample, with its rate; negative: before.
    pub fn attitude_at(&self, ahead_s: f32) -> Quaternion {
        let turn_rad = vector::scale(self.rate_rps, ahead_s);
        self.attitude.after(Quaternion::from_rotation(turn_rad))
    }

    /// Turns the world under the robot by a rotation vector in ENU.
    pub fn tilt(&mut self, by_rad: Vector3) {
        self.attitude = Quaternion::from_rotation(by_rad)
            .after(self.attitude)
            .normalised();
    }
}

#[cfg(test)]
mod tests;
