//! A magnet that the robot carries: a constant field in body axes.
//!
//! Level strength and vertical part of the earth's field do not depend on how the robot stands. What changes with its
//! attitude is carried along. Five states: the carried field and those two; a Kalman filter learns them, heading and
//! inclination are not touched by it.

use crate::math::{Vector3, vector};

const STATES: usize = 5;
type Row = [f32; STATES];

/// Prior of the carried field: (4 µT)².
const FIRST_CARRIED_UT2: f32 = 16.0;
const FIRST_FIELD_UT2: f32 = 1e4;
/// The field differs by 1 µT from place to place, for two seconds at a time, µT²·s.
const NOISE_UT2_S: f32 = 2.0;
/// The earth's part changes by 0.3 µT in a second, as a random walk.
const WANDER_UT2_PER_S: f32 = 0.3 * 0.3;
/// A calibrated magnetometer is this good; only what is more is a magnet.
const MIN_CARRIED_UT: f32 = 4.0;
/// … and more than so many variances of what is known of it.
const UNSURE: f32 = 4.0;
/// In variances: what is further off is passed, not carried.
const MAX_INNOVATION2: f32 = 16.0;

#[derive(Clone, Debug)]
pub(super) struct CarriedMagnet {
    carried_ut: Vector3,
    level_ut: f32,
    up_ut: f32,
    covariance: [Row; STATES],
}

impl CarriedMagnet {
    pub fn new() -> Self {
        let mut covariance = [[0.0; STATES]; STATES];
        for (index, row) in covariance.iter_mut().enumerate() {
            if let Some(variance) = row.get_mut(index) {
                *variance = if index < 3 {
                    FIRST_CARRIED_UT2
                } else {
                    FIRST_FIELD_UT2
                };
            }
        }
        Self {
            carried_ut: [0.0; 3],
            level_ut: 0.0,
            up_ut: 0.0,
            covariance,
        }
    }

    /// To be taken out of the samples, body axes: nothing below `MIN_CARRIED_UT`, then fading in.
    pub fn field_ut(&self) -> Vector3 {
        let size2 = vector::dot(self.carried_ut, self.carried_ut);
        let [[x, ..], [_, y, ..], [_, _, z, ..], ..] = self.covariance;
        let limit2 = MIN_CARRIED_UT * MIN_CARRIED_UT + UNSURE * (x + y + z);
        if size2 > limit2 {
            vector::scale(self.carried_ut, 1.0 - limit2 / size2)
        } else {
            [0.0; 3]
        }
    }

    /// A window's mean field in ENU, what of it is level, and the rows of its mean attitude. [`Self::field_ut`] is
    /// already taken out.
    pub fn observe(&mut self, field_ut: Vector3, level_ut: f32, rows: [Vector3; 3], window_s: f32) {
        let [x, y, up_ut] = field_ut;
        let [row_x, row_y, row_up] = rows;
        let toward = vector::add(
            vector::scale(row_x, x / level_ut),
            vector::scale(row_y, y / level_ut),
        );
        let left_in = vector::sub(self.carried_ut, self.field_ut());
        let [_, _, _, level, up] = &mut self.covariance;
        let ([.., level, _], [.., up]) = (level, up);
        *level += WANDER_UT2_PER_S * window_s;
        *up += WANDER_UT2_PER_S * window_s;
        let noise = NOISE_UT2_S / window_s;
        let [x, y, z] = toward;
        let residual = level_ut - self.level_ut - vector::dot(toward, left_in);
        let before = self.carried_ut;
        self.learn([x, y, z, 1.0, 0.0], residual, noise);
        let moved = vector::sub(self.carried_ut, before);
        let [x, y, z] = row_up;
        let left_in = vector::add(left_in, moved);
        let residual = up_ut - self.up_ut - vector::dot(row_up, left_in);
        self.learn([x, y, z, 0.0, 1.0], residual, noise);
    }

    #[inline(never)]
    fn learn(&mut self, direction: Row, residual: f32, noise: f32) {
        let mut spread = [0.0; STATES];
        for (to, row) in spread.iter_mut().zip(&self.covariance) {
            *to = product(row, &direction);
        }
        let variance = product(&spread, &direction) + noise;
        if residual * residual > MAX_INNOVATION2 * variance {
            return;
        }
        let inverse = 1.0 / variance;
        let gain = residual * inverse;
        let [x, y, z, level, up] = spread;
        self.carried_ut = vector::add(self.carried_ut, vector::scale([x, y, z], gain));
        self.level_ut += level * gain;
        self.up_ut += up * gain;
        for (row, weight) in self.covariance.iter_mut().zip(spread) {
            add_product(row, -weight * inverse, &spread);
        }
    }
}

#[inline(never)]
fn product(a: &Row, b: &Row) -> f32 {
    let mut sum = 0.0;
    for (a, b) in a.iter().zip(b) {
        sum += a * b;
    }
    sum
}

#[inline(never)]
fn add_product(to: &mut Row, factor: f32, row: &Row) {
    for (to, value) in to.iter_mut().zip(row) {
        *to += factor * value;
    }
}

#[cfg(test)]
mod tests;
