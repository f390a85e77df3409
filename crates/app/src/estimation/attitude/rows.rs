//! Sums over rows, compiled once and for any number of rows: unrolled at each use they would fill the flash.

use super::{covariance::Fast, window::Parameters};

/// `to += Σ weight · row`.
#[inline(never)]
pub(super) fn add_weighted(to: &mut Parameters, weights: &[f32], rows: &[Parameters]) {
    let mut sum = *to;
    for (weight, row) in weights.iter().zip(rows) {
        for (sum, value) in sum.iter_mut().zip(row) {
            *sum += weight * value;
        }
    }
    *to = sum;
}

/// `rows[i] -= weights[i] · factor · row`.
#[inline(never)]
pub(super) fn subtract_product(
    rows: &mut [Parameters],
    weights: &[f32],
    factor: f32,
    row: &Parameters,
) {
    let row = *row;
    for (to, weight) in rows.iter_mut().zip(weights) {
        let weight = weight * factor;
        for (to, value) in to.iter_mut().zip(row) {
            *to -= weight * value;
        }
    }
}

/// Scalar products of `row` with each of `rows`.
#[inline(never)]
pub(super) fn products(row: &Parameters, rows: &[Parameters], results: &mut [f32]) {
    let row = *row;
    for (result, other) in results.iter_mut().zip(rows) {
        let mut sum = 0.0;
        for (a, b) in row.iter().zip(other) {
            sum += a * b;
        }
        *result = sum;
    }
}

/// `to += factor · row`.
#[inline(never)]
pub(super) fn add_fast(to: &mut Fast, factor: f32, row: &Fast) {
    for (to, value) in to.iter_mut().zip(row) {
        *to += factor * value;
    }
}
