//! Arithmetic of rows, compiled once: unrolled at each use it would fill the flash.

use super::{covariance::Row, window::Parameters};

/// `to += factor · row`.
#[inline(never)]
pub(super) fn add(to: &mut Row, factor: f32, row: &Row) {
    for (to, value) in to.iter_mut().zip(row) {
        *to += factor * value;
    }
}

/// Scalar product.
#[inline(never)]
pub(super) fn product(a: &Parameters, b: &Parameters) -> f32 {
    let mut sum = 0.0;
    for (a, b) in a.iter().zip(b) {
        sum += a * b;
    }
    sum
}
