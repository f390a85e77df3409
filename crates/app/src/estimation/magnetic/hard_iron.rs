//! Hard iron: a constant field in body axes, from magnets and steel that the robot carries.
//!
//! The horizontal and the vertical strength of the earth's field do not depend on the attitude. What changes with the
//! attitude is hard iron. A Kalman filter estimates five states: the hard-iron bias and those two strengths. It has no
//! influence on heading and tilt.

use crate::math::{Vector3, vector};

const STATES: usize = 5;
type StateVector = [f32; STATES];

/// Initial variance of the bias on each axis, (4 µT)².
const INITIAL_BIAS_UT2: f32 = 16.0;
/// Initial variance of the two strengths, (100 µT)².
const INITIAL_FIELD_UT2: f32 = 1e4;
/// Measurement noise: the field differs by 1 µT from place to place, for two seconds at a time, µT²·s.
const NOISE_UT2_S: f32 = 2.0;
/// Process noise of the two strengths: a random walk of 0.3 µT in one second.
const FIELD_NOISE_UT2_PER_S: f32 = 0.3 * 0.3;
/// A calibrated magnetometer is this good. Only a larger bias is compensated.
const MIN_BIAS_UT: f32 = 4.0;
/// The bias must also exceed two of its own standard deviations.
const MIN_BIAS_SIGMA2: f32 = 4.0;
/// An innovation beyond four standard deviations comes from a magnet that is passed, not carried.
const GATE_SIGMA2: f32 = 16.0;

/// The filter. State: bias in body axes, horizontal and vertical (up) strength of the earth's field, µT.
#[derive(Clone, Debug)]
pub(super) struct HardIron {
    bias_ut: Vector3,
    horizontal_ut: f32,
    vertical_ut: f32,
    covariance: [StateVector; STATES],
}

impl HardIron {
    pub fn new() -> Self {
        let mut covariance = [[0.0; STATES]; STATES];
        for (index, row) in covariance.iter_mut().enumerate() {
            if let Some(variance) = row.get_mut(index) {
                *variance = if index < 3 {
                    INITIAL_BIAS_UT2
                } else {
                    INITIAL_FIELD_UT2
                };
            }
        }
        Self {
            bias_ut: [0.0; 3],
            horizontal_ut: 0.0,
            vertical_ut: 0.0,
            covariance,
        }
    }

    /// The field to subtract from the samples, in body axes. It is zero for a bias below `MIN_BIAS_UT` and fades in above.
    pub fn compensation_ut(&self) -> Vector3 {
        let size2 = vector::dot(self.bias_ut, self.bias_ut);
        let [[x, ..], [_, y, ..], [_, _, z, ..], ..] = self.covariance;
        let limit2 = MIN_BIAS_UT * MIN_BIAS_UT + MIN_BIAS_SIGMA2 * (x + y + z);
        if size2 > limit2 {
            vector::scale(self.bias_ut, 1.0 - limit2 / size2)
        } else {
            [0.0; 3]
        }
    }

    /// Updates the filter with a window of `window_s`: its mean field in ENU after compensation, the horizontal strength
    /// of that, and its mean attitude (body → ENU, by rows).
    pub fn update(
        &mut self,
        field_ut: Vector3,
        horizontal_ut: f32,
        rows: [Vector3; 3],
        window_s: f32,
    ) {
        let [x, y, vertical_ut] = field_ut;
        let [row_x, row_y, row_up] = rows;
        let horizontal = vector::add(
            vector::scale(row_x, x / horizontal_ut),
            vector::scale(row_y, y / horizontal_ut),
        );
        let remaining_ut = vector::sub(self.bias_ut, self.compensation_ut());
        let [_, _, _, level, up] = &mut self.covariance;
        let ([.., level, _], [.., up]) = (level, up);
        *level += FIELD_NOISE_UT2_PER_S * window_s;
        *up += FIELD_NOISE_UT2_PER_S * window_s;
        let noise = NOISE_UT2_S / window_s;
        let [x, y, z] = horizontal;
        let innovation = horizontal_ut - self.horizontal_ut - vector::dot(horizontal, remaining_ut);
        let before = self.bias_ut;
        self.update_scalar([x, y, z, 1.0, 0.0], innovation, noise);
        let change = vector::sub(self.bias_ut, before);
        let [x, y, z] = row_up;
        let remaining_ut = vector::add(remaining_ut, change);
        let innovation = vertical_ut - self.vertical_ut - vector::dot(row_up, remaining_ut);
        self.update_scalar([x, y, z, 0.0, 1.0], innovation, noise);
    }

    /// Update with one measurement whose Jacobian is h. It is skipped if the innovation fails the gate.
    #[inline(never)]
    fn update_scalar(&mut self, jacobian: StateVector, innovation: f32, noise: f32) {
        // P hᵀ.
        let mut cross_covariance = [0.0; STATES];
        for (to, row) in cross_covariance.iter_mut().zip(&self.covariance) {
            *to = dot(row, &jacobian);
        }
        let variance = dot(&cross_covariance, &jacobian) + noise;
        if innovation * innovation > GATE_SIGMA2 * variance {
            return;
        }
        let inverse = 1.0 / variance;
        let weight = innovation * inverse;
        let [x, y, z, horizontal, vertical] = cross_covariance;
        self.bias_ut = vector::add(self.bias_ut, vector::scale([x, y, z], weight));
        self.horizontal_ut += horizontal * weight;
        self.vertical_ut += vertical * weight;
        for (row, covariance) in self.covariance.iter_mut().zip(cross_covariance) {
            add_scaled(row, -covariance * inverse, &cross_covariance);
        }
    }
}

#[inline(never)]
fn dot(a: &StateVector, b: &StateVector) -> f32 {
    let mut sum = 0.0;
    for (a, b) in a.iter().zip(b) {
        sum += a * b;
    }
    sum
}

#[inline(never)]
fn add_scaled(to: &mut StateVector, factor: f32, vector: &StateVector) {
    for (to, value) in to.iter_mut().zip(vector) {
        *to += factor * value;
    }
}

#[cfg(test)]
mod tests;
