//! What a fifth of a second of samples adds up to.

use super::strapdown::Carried;
use crate::math::{Vector3, vector};

/// bias x, y, z, then misalignment row by row.
pub(super) const PARAMETERS: usize = 12;
pub(super) type Parameters = [f32; PARAMETERS];

/// Samples in a window.
const SAMPLES: u8 = 40;

#[derive(Clone, Debug)]
pub(super) struct Window {
    /// How an error of each gyro parameter turns the attitude: −∫R dt and −∫R ⊗ ω dt, one row for each axis of ENU.
    pub turn_by_parameter: [Parameters; 3],
    /// Of one sample that is not in those rows yet: measured turn in rad, duration.
    turn_rad: Vector3,
    turn_s: f32,
    accel_sum_mps2: Vector3,
    samples: u8,
    pub duration_s: f32,
    /// ∫ω² dt.
    pub turned_rad2_per_s: f32,
    /// With the accelerometer at the end of its range.
    pub blind_s: f32,
    /// Square of the angle by which the attitude may be off because the gyro did not see it.
    pub unseen_rad2: f32,
}

impl Window {
    pub const fn new() -> Self {
        Self {
            turn_by_parameter: [[0.0; PARAMETERS]; 3],
            turn_rad: [0.0; 3],
            turn_s: 0.0,
            accel_sum_mps2: [0.0; 3],
            samples: 0,
            duration_s: 0.0,
            turned_rad2_per_s: 0.0,
            blind_s: 0.0,
            unseen_rad2: 0.0,
        }
    }

    pub const fn is_full(&self) -> bool {
        self.samples >= SAMPLES
    }

    /// One sample; [`Self::add_accel`] is its other half.
    pub fn add_turn(&mut self, carried: &Carried, gyro_rps: Vector3, rate_rps: Vector3, dt_s: f32) {
        self.samples = self.samples.saturating_add(1);
        self.duration_s += dt_s;
        self.turned_rad2_per_s += vector::dot(rate_rps, rate_rps) * dt_s;
        self.unseen_rad2 += carried.unseen_rad2;
        self.turn_s += dt_s;
        self.turn_rad = vector::add(self.turn_rad, vector::scale(gyro_rps, dt_s));
        // Two samples at a time: the filter needs it no finer, and it is half the work.
        if self.samples.is_multiple_of(2) {
            for (row, axis) in self.turn_by_parameter.iter_mut().zip(carried.middle) {
                add_row(row, axis, self.turn_rad, self.turn_s);
            }
            self.turn_rad = [0.0; 3];
            self.turn_s = 0.0;
        }
    }

    pub fn add_accel(&mut self, accel_enu_mps2: Vector3) {
        self.accel_sum_mps2 = vector::add(self.accel_sum_mps2, accel_enu_mps2);
    }

    /// Mean specific force, ENU.
    pub fn accel_mps2(&self) -> Vector3 {
        let count = if self.samples == 0 { 1 } else { self.samples };
        vector::scale(self.accel_sum_mps2, 1.0 / f32::from(count))
    }
}

#[inline(never)]
fn add_row(row: &mut Parameters, [rx, ry, rz]: Vector3, [gx, gy, gz]: Vector3, s: f32) {
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
