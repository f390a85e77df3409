//! Sums over one filter window of 0.2 s.

use super::error_state::{GYRO_PARAMETERS, GyroParameters};
use crate::{
    estimation::strapdown::MidSample,
    math::{Vector3, vector},
};

/// IMU samples in a window.
const SAMPLES: u8 = 40;

/// What the filter needs of the samples of one window.
#[derive(Clone, Debug)]
pub(super) struct Window {
    /// Φ = ∂θ/∂p, how an error of each gyro parameter has rotated the attitude: −∫R dt and −∫R ⊗ ω dt, one row for each
    /// axis of ENU.
    pub angle_jacobian: [GyroParameters; 3],
    /// Measured rotation (rad) of a sample that is not in the Jacobian yet.
    rotation_rad: Vector3,
    /// Duration of that sample.
    rotation_s: f32,
    accel_sum_mps2: Vector3,
    samples: u8,
    pub duration_s: f32,
    /// ∫ω² dt, rad²/s.
    pub squared_rate_integral: f32,
    /// Time with the accelerometer saturated.
    pub accel_clipped_s: f32,
    /// Variance of the angle that was interpolated across missing samples, rad².
    pub gap_error_rad2: f32,
}

impl Window {
    pub const fn new() -> Self {
        Self {
            angle_jacobian: [[0.0; GYRO_PARAMETERS]; 3],
            rotation_rad: [0.0; 3],
            rotation_s: 0.0,
            accel_sum_mps2: [0.0; 3],
            samples: 0,
            duration_s: 0.0,
            squared_rate_integral: 0.0,
            accel_clipped_s: 0.0,
            gap_error_rad2: 0.0,
        }
    }

    pub const fn is_full(&self) -> bool {
        self.samples >= SAMPLES
    }

    /// Adds the gyro's half of a sample; [`Self::add_accel`] adds the other. `gyro_rps` is the measured rate, `rate_rps`
    /// the corrected one.
    pub fn add_rotation(
        &mut self,
        mid_sample: &MidSample,
        gyro_rps: Vector3,
        rate_rps: Vector3,
        dt_s: f32,
    ) {
        self.samples = self.samples.saturating_add(1);
        self.duration_s += dt_s;
        self.squared_rate_integral += vector::dot(rate_rps, rate_rps) * dt_s;
        self.gap_error_rad2 += mid_sample.gap_error_rad2;
        self.rotation_s += dt_s;
        self.rotation_rad = vector::add(self.rotation_rad, vector::scale(gyro_rps, dt_s));
        // The Jacobian takes two samples at a time: the filter needs it no finer, and it is half the work.
        if self.samples.is_multiple_of(2) {
            for (row, axis) in self.angle_jacobian.iter_mut().zip(mid_sample.rotation) {
                add_to_row(row, axis, self.rotation_rad, self.rotation_s);
            }
            self.rotation_rad = [0.0; 3];
            self.rotation_s = 0.0;
        }
    }

    /// Adds the specific force of a sample, in ENU.
    pub fn add_accel(&mut self, accel_enu_mps2: Vector3) {
        self.accel_sum_mps2 = vector::add(self.accel_sum_mps2, accel_enu_mps2);
    }

    /// Mean specific force in ENU.
    pub fn accel_mps2(&self) -> Vector3 {
        let count = if self.samples == 0 { 1 } else { self.samples };
        vector::scale(self.accel_sum_mps2, 1.0 / f32::from(count))
    }
}

/// Adds one interval of `s` seconds to a row of the Jacobian: a row of R, and the rotation measured in the interval.
#[inline(never)]
fn add_to_row(row: &mut GyroParameters, [rx, ry, rz]: Vector3, [gx, gy, gz]: Vector3, s: f32) {
    let [bx, by, bz, xx, xy, xz, yx, yy, yz, zx, zy, zz] = row;
    *bx -= rx * s;
    *by -= ry * s;
    *bz -= rz * s;
    *xx -= rx * gx;
    *xy -= rx * gy;
    *xz -= rx * gz;
    *yx -= ry * gx;
    *yy -= ry * gy;
    *yz -= ry * gz;
    *zx -= rz * gx;
    *zy -= rz * gy;
    *zz -= rz * gz;
}

#[cfg(test)]
mod tests;
