//! How sure the filter is, and of what: the covariance of its seventeen errors.
//!
//! Five fast errors (three angles about ENU, two speeds) and twelve slow ones (gyro bias and misalignment), kept as the
//! three blocks of the symmetric matrix. All blocks are stored in full, so that every operation runs along rows.

use super::{
    rows,
    window::{PARAMETERS, Parameters},
};
use crate::{estimation::magnetic::Certainty, math::scalar};

/// Angles about east, north and up in rad, speed east and north in m/s.
pub(super) const FAST: usize = 5;
pub(super) type Fast = [f32; FAST];

/// One correction of all that is estimated.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Correction {
    pub fast: Fast,
    pub parameters: Parameters,
}

#[derive(Clone, Debug)]
pub(super) struct Covariance {
    pub fast: [Fast; FAST],
    /// Fast error (row) with slow error (column).
    pub cross: [Parameters; FAST],
    pub slow: [Parameters; PARAMETERS],
}

/// A column of the covariance: what one error has to do with all others.
#[derive(Clone, Copy, Debug)]
pub(super) struct Column {
    pub fast: Fast,
    pub slow: Parameters,
    /// Its own variance.
    pub variance: f32,
}

/// An innovation beyond so many standard deviations counts as that many.
const MAX_INNOVATION: f32 = 5.0;

const DEG: f32 = 1.0_f32.to_radians();
/// Before anything is known: inclination and heading 10°, speed 1 m/s, bias 3 °/s, scale and axes 0.6 %.
pub(super) const FIRST_ANGLE: f32 = (10.0 * DEG) * (10.0 * DEG);
const FIRST_SPEED: f32 = 1.0;
const FIRST_BIAS: f32 = (3.0 * DEG) * (3.0 * DEG);
/// Below this a variance has no meaning in single precision.
pub(super) const LEAST_VARIANCE: f32 = 1e-12;
const FIRST_MISALIGNMENT: f32 = 0.006 * 0.006;

impl Covariance {
    #[inline(never)]
    pub fn new() -> Self {
        let mut new = Self {
            fast: [[0.0; FAST]; FAST],
            cross: [[0.0; PARAMETERS]; FAST],
            slow: [[0.0; PARAMETERS]; PARAMETERS],
        };
        for (index, row) in new.fast.iter_mut().enumerate() {
            let first = if index < 3 { FIRST_ANGLE } else { FIRST_SPEED };
            set(row, index, first);
        }
        for (index, row) in new.slow.iter_mut().enumerate() {
            let first = if index < 3 {
                FIRST_BIAS
            } else {
                FIRST_MISALIGNMENT
            };
            set(row, index, first);
        }
        new
    }

    /// The angles about ENU may be off by this much more than known so far, rad².
    pub fn doubt_angles(&mut self, more: [f32; 3]) {
        for (index, (row, more)) in self.fast.iter_mut().zip(more).enumerate() {
            if let Some(variance) = row.get_mut(index) {
                *variance += more;
            }
        }
    }

    /// The gyro bias is another one from now on, known as well as `variance` says.
    pub fn replace_bias(&mut self, variance: f32) {
        for row in &mut self.cross {
            let [x, y, z, ..] = row;
            (*x, *y, *z) = (0.0, 0.0, 0.0);
        }
        for (index, row) in self.slow.iter_mut().enumerate() {
            if index < 3 {
                *row = [0.0; PARAMETERS];
                set(row, index, variance);
            } else {
                let [x, y, z, ..] = row;
                (*x, *y, *z) = (0.0, 0.0, 0.0);
            }
        }
    }

    pub fn certainty(&self) -> Certainty {
        let [[x, ..], [_, y, ..], [_, _, z, ..], ..] = self.fast;
        Certainty {
            tilt: scalar::max(x, y),
            heading: z,
        }
    }

    /// Of the gyro bias.
    pub const fn bias_variances(&self) -> [f32; 3] {
        let [[x, ..], [_, y, ..], [_, _, z, ..], ..] = self.slow;
        [x, y, z]
    }

    /// The bias is another one after a while; rounding must not make a variance vanish.
    pub fn wander(&mut self, bias_noise: f32) {
        for (index, row) in self.slow.iter_mut().enumerate() {
            let Some(variance) = row.get_mut(index) else {
                continue;
            };
            if index < 3 && *variance < FIRST_BIAS {
                *variance += bias_noise;
            }
            *variance = scalar::max(*variance, LEAST_VARIANCE);
        }
    }

    pub fn fast_column(&self, index: usize) -> Option<Column> {
        let (fast, slow) = (*self.fast.get(index)?, *self.cross.get(index)?);
        Some(Column {
            fast,
            slow,
            variance: *fast.get(index)?,
        })
    }

    pub fn slow_column(&self, index: usize) -> Option<Column> {
        let slow = *self.slow.get(index)?;
        let mut fast = [0.0; FAST];
        for (to, row) in fast.iter_mut().zip(&self.cross) {
            *to = *row.get(index)?;
        }
        Some(Column {
            fast,
            slow,
            variance: *slow.get(index)?,
        })
    }

    /// Learns from a measurement of one error, `innovation` off with variance `noise`. False if the covariance has
    /// broken down.
    #[must_use]
    pub fn observe(
        &mut self,
        column: &Column,
        innovation: f32,
        noise: f32,
        correction: &mut Correction,
    ) -> bool {
        let spread = column.variance + noise;
        // Also false for NaN.
        let sound = column.variance >= 0.0 && spread.is_normal();
        if !sound {
            return false;
        }
        let inverse = 1.0 / spread;
        let mut gain = innovation * inverse;
        if innovation * gain > MAX_INNOVATION * MAX_INNOVATION {
            let limit = MAX_INNOVATION * scalar::inverse_sqrt(spread);
            gain = if gain > 0.0 { limit } else { -limit };
        }
        rows::add_weighted(&mut correction.parameters, &[gain], &[column.slow]);
        rows::add_fast(&mut correction.fast, gain, &column.fast);
        for (row, weight) in self.fast.iter_mut().zip(column.fast) {
            rows::add_fast(row, -weight * inverse, &column.fast);
        }
        rows::subtract_product(&mut self.cross, &column.fast, inverse, &column.slow);
        rows::subtract_product(&mut self.slow, &column.slow, inverse, &column.slow);
        true
    }
}

fn set<const N: usize>(row: &mut [f32; N], index: usize, value: f32) {
    if let Some(place) = row.get_mut(index) {
        *place = value;
    }
}

#[cfg(test)]
mod tests;
