//! The covariance P of the seventeen error states.
//!
//! The symmetric matrix is stored in full, so that every operation runs along rows.

use core::ops::Range;

use super::error_state::{self, BIAS, ErrorVector, GYRO_PARAMETERS, MISALIGNMENT, SPEED, STATES};
use crate::{
    estimation::{attitude_variance::AttitudeVariance, measurement::Measurement},
    math::{Vector3, scalar, vector},
};

/// The covariance matrix, by rows in the order of [`ErrorVector`].
#[derive(Clone, Debug)]
pub(super) struct Covariance {
    pub rows: [ErrorVector; STATES],
}

/// The update with one scalar measurement, which is done in two steps.
#[derive(Clone, Debug, Default)]
pub(super) struct ScalarUpdate {
    /// P hᵀ, the column of the measured state before the update.
    column: ErrorVector,
    /// 1/S, where S is the innovation variance.
    inverse_variance: f32,
}

/// Rows of P that the first step of an update covers.
const FIRST_ROWS: usize = 8;
/// An innovation beyond this many standard deviations is clipped to that many.
const MAX_INNOVATION_SIGMA: f32 = 5.0;

const DEG: f32 = 1.0_f32.to_radians();
/// Initial variance of each angle, (10°)².
pub(super) const INITIAL_ANGLE: f32 = (10.0 * DEG) * (10.0 * DEG);
/// Initial variance of the velocity, (1 m/s)².
const INITIAL_SPEED: f32 = 1.0;
/// Initial variance of the gyro bias, (3 °/s)².
const INITIAL_BIAS: f32 = (3.0 * DEG) * (3.0 * DEG);
/// Initial variance of scale and misalignment, (0.6 %)².
const INITIAL_MISALIGNMENT: f32 = 0.006 * 0.006;
/// Variance of the tilt after levelling at a rest of 0.6 s, (0.5°)².
const TILT_AT_REST: f32 = (0.5 * DEG) * (0.5 * DEG);
/// Variance of the velocity after that, (0.1 m/s)².
const SPEED_AT_REST: f32 = 0.1 * 0.1;
/// Variance of a heading of which nothing is known, (90°)².
const UNKNOWN_HEADING: f32 = (90.0 * DEG) * (90.0 * DEG);
/// Below this a variance has no meaning in single precision.
const MIN_VARIANCE: f32 = 1e-12;

impl Covariance {
    /// All zero; [`Self::reset`] gives it its initial values.
    pub const fn new() -> Self {
        Self {
            rows: [[0.0; STATES]; STATES],
        }
    }

    /// Sets the initial variances and no correlation.
    #[inline(never)]
    pub fn reset(&mut self) {
        for (index, row) in self.rows.iter_mut().enumerate() {
            *row = [0.0; STATES];
            if let Some(variance) = row.get_mut(index) {
                *variance = match index {
                    ..SPEED => INITIAL_ANGLE,
                    SPEED..BIAS => INITIAL_SPEED,
                    BIAS..MISALIGNMENT => INITIAL_BIAS,
                    MISALIGNMENT.. => INITIAL_MISALIGNMENT,
                };
            }
        }
    }

    /// Adds variance to the states from `first` on. Afterwards none is below the least variance, whatever rounding did.
    #[inline(never)]
    pub fn add_variances(&mut self, first: usize, added: &[f32]) {
        for (index, added) in (first..).zip(added) {
            if let Some(variance) = self.variance_mut(index) {
                *variance = scalar::max(*variance + added, MIN_VARIANCE);
            }
        }
    }

    fn variance_mut(&mut self, index: usize) -> Option<&mut f32> {
        self.rows.get_mut(index)?.get_mut(index)
    }

    /// Gives the states from `first` on these variances and removes their correlation with all others.
    #[cold]
    #[inline(never)]
    pub fn reset_states(&mut self, first: usize, variances: &[f32]) {
        let states = first..first.saturating_add(variances.len());
        for (index, row) in self.rows.iter_mut().enumerate() {
            if states.contains(&index) {
                row.fill(0.0);
            } else if let Some(part) = row.get_mut(states.clone()) {
                part.fill(0.0);
            }
        }
        self.add_variances(first, variances);
    }

    /// Resets the gyro bias to `variance`, (rad/s)².
    pub fn reset_bias(&mut self, variance: f32) {
        self.reset_states(BIAS, &[variance; 3]);
    }

    /// Adds the rotation that may have been lost while the gyro was saturated. `lost_rad` has a row for each axis of ENU,
    /// with what each body axis may have rotated beyond the measurement. The velocity is reset: the accelerometer does not
    /// show an impact as it was.
    #[cold]
    #[inline(never)]
    pub fn add_lost_rotation(&mut self, lost_rad: &[Vector3; 3]) {
        let sum: f32 = lost_rad.iter().map(|row| vector::dot(*row, *row)).sum();
        let share = if sum > UNKNOWN_HEADING {
            UNKNOWN_HEADING / sum
        } else {
            1.0
        };
        for (row, one) in self.rows.iter_mut().zip(lost_rad) {
            for (part, other) in row.iter_mut().zip(lost_rad) {
                *part += share * vector::dot(*one, *other);
            }
        }
        self.reset_states(SPEED, &[INITIAL_SPEED; 2]);
    }

    /// Resets tilt and velocity after levelling at rest. The heading keeps its variance, plus `added_variance` (rad²).
    #[cold]
    #[inline(never)]
    pub fn reset_tilt(&mut self, added_variance: f32) {
        let [_, _, heading] = self.variances(0);
        let heading = scalar::min(heading + added_variance, UNKNOWN_HEADING);
        self.reset_states(
            0,
            &[
                TILT_AT_REST,
                TILT_AT_REST,
                heading,
                SPEED_AT_REST,
                SPEED_AT_REST,
            ],
        );
    }

    /// Variances of tilt and heading.
    pub fn attitude_variance(&self) -> AttitudeVariance {
        let [x, y, heading] = self.variances(0);
        AttitudeVariance {
            tilt: scalar::max(x, y),
            heading,
        }
    }

    /// Variances of the three states from `first` on.
    pub fn variances(&self, first: usize) -> [f32; 3] {
        let mut found = [0.0; 3];
        for (index, to) in (first..).zip(&mut found) {
            let variance = self.rows.get(index).and_then(|row| row.get(index));
            *to = variance.copied().unwrap_or_default();
        }
        found
    }

    /// Adds the random walk of the gyro bias, up to the initial variance. Also keeps the variances of the misalignment
    /// above the least one.
    pub fn add_bias_noise(&mut self, bias_noise: f32) {
        let added = self.variances(BIAS).map(|variance| {
            if variance < INITIAL_BIAS {
                bias_noise
            } else {
                0.0
            }
        });
        self.add_variances(BIAS, &added);
        self.add_variances(MISALIGNMENT, &[0.0; GYRO_PARAMETERS - 3]);
    }

    /// Copies the rows of angles and velocity, which a prediction has changed, into the matching columns.
    pub fn symmetrise(&mut self) {
        for done in 1..=BIAS {
            let Some((changed, others)) = self.rows.split_at_mut_checked(done) else {
                return;
            };
            let Some(from) = changed.last() else {
                return;
            };
            for (row, value) in others.iter_mut().zip(from.iter().skip(done)) {
                if let Some(place) = row.get_mut(done.saturating_sub(1)) {
                    *place = *value;
                }
            }
        }
    }

    /// First step of the update with a measurement of the state `index`: gain, correction, and the first rows of P.
    /// `correction` is the error estimate so far. Returns false if the covariance is no longer valid.
    #[must_use]
    #[inline(never)]
    pub fn begin_update(
        &mut self,
        index: usize,
        measurement: &Measurement,
        correction: &mut ErrorVector,
        update: &mut ScalarUpdate,
    ) -> bool {
        let (Some(column), Some(so_far)) = (self.rows.get(index), correction.get(index)) else {
            return false;
        };
        update.column = *column;
        let variance = column.get(index).copied().unwrap_or_default();
        let innovation = measurement.innovation - so_far;
        let innovation_variance = variance + measurement.variance;
        // Also false for NaN.
        let valid = variance >= 0.0 && innovation_variance.is_normal();
        if !valid {
            return false;
        }
        update.inverse_variance = 1.0 / innovation_variance;
        // The gain K = P hᵀ / S times the innovation, without P hᵀ.
        let mut weight = innovation * update.inverse_variance;
        if innovation * weight > MAX_INNOVATION_SIGMA * MAX_INNOVATION_SIGMA {
            let limit = MAX_INNOVATION_SIGMA * scalar::inverse_sqrt(innovation_variance);
            weight = if weight > 0.0 { limit } else { -limit };
        }
        error_state::add_scaled(correction, weight, &update.column);
        self.reduce(update, 0..FIRST_ROWS);
        true
    }

    /// Second step: the other rows of P.
    pub fn finish_update(&mut self, update: &ScalarUpdate) {
        self.reduce(update, FIRST_ROWS..STATES);
    }

    /// P ← P − P hᵀ h P / S, some of the rows.
    #[inline(never)]
    fn reduce(&mut self, update: &ScalarUpdate, rows: Range<usize>) {
        let weights = update.column.get(rows.clone());
        if let (Some(rows), Some(weights)) = (self.rows.get_mut(rows), weights) {
            for (row, weight) in rows.iter_mut().zip(weights) {
                error_state::add_scaled(row, -weight * update.inverse_variance, &update.column);
            }
        }
    }
}

#[cfg(test)]
mod tests;
