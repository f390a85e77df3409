//! How sure the filter is, and of what: the covariance of its seventeen errors.
//!
//! Three angles about ENU, two speeds, then the twelve of the gyro model. The symmetric matrix is stored in full, so that
//! every operation runs along rows.

use core::ops::Range;

use super::{
    error_filter::Finding,
    rows,
    window::{PARAMETERS, Parameters},
};
use crate::{
    estimation::magnetic::Certainty,
    math::{Vector3, scalar, vector},
};

/// Angles about east, north and up in rad, speed east and north in m/s, gyro bias and misalignment.
pub(super) const ERRORS: usize = 17;
pub(super) type Row = [f32; ERRORS];
pub(super) const UP: usize = 2;
pub(super) const SPEED: usize = 3;
pub(super) const BIAS: usize = 5;
const MISALIGNMENT: usize = 8;

#[derive(Clone, Debug)]
pub(super) struct Covariance {
    pub rows: [Row; ERRORS],
}

/// A measurement of one error that is being learnt from, in two pieces of work.
#[derive(Clone, Debug, Default)]
pub(super) struct Lesson {
    /// What the measured error has to do with all others.
    column: Row,
    /// Of the innovation's variance.
    inverse: f32,
}

/// Rows that the first piece of work covers.
const FIRST_PIECE: usize = 8;
/// An innovation beyond so many standard deviations counts as that many.
const MAX_INNOVATION: f32 = 5.0;

const DEG: f32 = 1.0_f32.to_radians();
/// Before anything is known: inclination and heading 10°, speed 1 m/s, bias 3 °/s, scale and axes 0.6 %.
pub(super) const FIRST_ANGLE: f32 = (10.0 * DEG) * (10.0 * DEG);
const FIRST_SPEED: f32 = 1.0;
const FIRST_BIAS: f32 = (3.0 * DEG) * (3.0 * DEG);
const FIRST_MISALIGNMENT: f32 = 0.006 * 0.006;
/// Up as a rest of 0.6 s shows it: 0.5°, and 0.1 m/s of speed.
const UP_AT_REST: f32 = (0.5 * DEG) * (0.5 * DEG);
const SPEED_AT_REST: f32 = 0.1 * 0.1;
/// Of a heading of which nothing is known.
const HALF_TURN: f32 = (90.0 * DEG) * (90.0 * DEG);
/// Below this a variance has no meaning in single precision.
const LEAST_VARIANCE: f32 = 1e-12;

impl Covariance {
    pub const fn new() -> Self {
        Self {
            rows: [[0.0; ERRORS]; ERRORS],
        }
    }

    /// Nothing is known.
    #[inline(never)]
    pub fn restart(&mut self) {
        for (index, row) in self.rows.iter_mut().enumerate() {
            *row = [0.0; ERRORS];
            if let Some(variance) = row.get_mut(index) {
                *variance = match index {
                    ..SPEED => FIRST_ANGLE,
                    SPEED..BIAS => FIRST_SPEED,
                    BIAS..MISALIGNMENT => FIRST_BIAS,
                    MISALIGNMENT.. => FIRST_MISALIGNMENT,
                };
            }
        }
    }

    /// The errors from `first` on are larger by these variances than known so far; rounding must not make one vanish.
    #[inline(never)]
    pub fn doubt(&mut self, first: usize, more: &[f32]) {
        for (index, more) in (first..).zip(more) {
            if let Some(variance) = self.variance_mut(index) {
                *variance = scalar::max(*variance + more, LEAST_VARIANCE);
            }
        }
    }

    fn variance_mut(&mut self, index: usize) -> Option<&mut f32> {
        self.rows.get_mut(index)?.get_mut(index)
    }

    /// The errors from `first` on are others from now on, with these variances and nothing to do with what was known.
    #[cold]
    #[inline(never)]
    pub fn replace(&mut self, first: usize, variances: &[f32]) {
        let replaced = first..first.saturating_add(variances.len());
        for (index, row) in self.rows.iter_mut().enumerate() {
            if replaced.contains(&index) {
                row.fill(0.0);
            } else if let Some(part) = row.get_mut(replaced.clone()) {
                part.fill(0.0);
            }
        }
        self.doubt(first, variances);
    }

    /// The gyro bias is another one from now on, known as well as `variance` says.
    pub fn replace_bias(&mut self, variance: f32) {
        self.replace(BIAS, &[variance; 3]);
    }

    /// The gyro did not see a part of the turn. `unseen_rad`: by each axis of ENU, what each of the body's may have
    /// turned further. Nor was the acceleration seen as it was, so the speed felt begins anew.
    #[cold]
    #[inline(never)]
    pub fn doubt_turn(&mut self, unseen_rad: &[Vector3; 3]) {
        let sum: f32 = unseen_rad.iter().map(|row| vector::dot(*row, *row)).sum();
        let share = if sum > HALF_TURN {
            HALF_TURN / sum
        } else {
            1.0
        };
        for (row, one) in self.rows.iter_mut().zip(unseen_rad) {
            for (part, other) in row.iter_mut().zip(unseen_rad) {
                *part += share * vector::dot(*one, *other);
            }
        }
        self.replace(SPEED, &[FIRST_SPEED; 2]);
    }

    /// Rest has shown where up is. The heading is what it was, give or take `turn_variance`.
    #[cold]
    #[inline(never)]
    pub fn know_up(&mut self, turn_variance: f32) {
        let [_, _, heading] = self.variances(0);
        let heading = scalar::min(heading + turn_variance, HALF_TURN);
        self.replace(
            0,
            &[
                UP_AT_REST,
                UP_AT_REST,
                heading,
                SPEED_AT_REST,
                SPEED_AT_REST,
            ],
        );
    }

    pub fn certainty(&self) -> Certainty {
        let [x, y, heading] = self.variances(0);
        Certainty {
            tilt: scalar::max(x, y),
            heading,
        }
    }

    /// Of three errors from `first` on.
    pub fn variances(&self, first: usize) -> [f32; 3] {
        let mut found = [0.0; 3];
        for (index, to) in (first..).zip(&mut found) {
            let variance = self.rows.get(index).and_then(|row| row.get(index));
            *to = variance.copied().unwrap_or_default();
        }
        found
    }

    /// The bias is another one after a while, unless nothing is known of it anyway.
    pub fn wander(&mut self, bias_noise: f32) {
        let more = self.variances(BIAS).map(|variance| {
            if variance < FIRST_BIAS {
                bias_noise
            } else {
                0.0
            }
        });
        self.doubt(BIAS, &more);
        self.doubt(MISALIGNMENT, &[0.0; PARAMETERS - 3]);
    }

    /// The fast rows have changed: the rows of the gyro model have the same in their columns.
    pub fn mirror(&mut self) {
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

    /// The first piece of learning from a measurement of the error `index`; `correction` is what was learnt so far. False
    /// if the covariance has broken down.
    #[must_use]
    #[inline(never)]
    pub fn begin_lesson(
        &mut self,
        index: usize,
        finding: &Finding,
        correction: &mut Row,
        lesson: &mut Lesson,
    ) -> bool {
        let (Some(column), Some(so_far)) = (self.rows.get(index), correction.get(index)) else {
            return false;
        };
        lesson.column = *column;
        let variance = column.get(index).copied().unwrap_or_default();
        let innovation = finding.innovation - so_far;
        let spread = variance + finding.noise;
        // Also false for NaN.
        let sound = variance >= 0.0 && spread.is_normal();
        if !sound {
            return false;
        }
        lesson.inverse = 1.0 / spread;
        let mut gain = innovation * lesson.inverse;
        if innovation * gain > MAX_INNOVATION * MAX_INNOVATION {
            let limit = MAX_INNOVATION * scalar::inverse_sqrt(spread);
            gain = if gain > 0.0 { limit } else { -limit };
        }
        rows::add(correction, gain, &lesson.column);
        self.learn(lesson, 0..FIRST_PIECE);
        true
    }

    /// The second piece.
    pub fn end_lesson(&mut self, lesson: &Lesson) {
        self.learn(lesson, FIRST_PIECE..ERRORS);
    }

    #[inline(never)]
    fn learn(&mut self, lesson: &Lesson, piece: Range<usize>) {
        let weights = lesson.column.get(piece.clone());
        if let (Some(rows), Some(weights)) = (self.rows.get_mut(piece), weights) {
            for (row, weight) in rows.iter_mut().zip(weights) {
                rows::add(row, -weight * lesson.inverse, &lesson.column);
            }
        }
    }
}

/// The part of a row that belongs to the gyro model.
pub(super) const fn parameters(row: &Row) -> &Parameters {
    let [_, _, _, _, _, parameters @ ..] = row;
    parameters
}

#[cfg(test)]
mod tests;
