//! Mean, root mean square and median of samples.

use nalgebra::Vector3;

pub(crate) fn mean(values: impl ExactSizeIterator<Item = Vector3<f64>>) -> Vector3<f64> {
    let count = values.len().max(1) as f64;
    values.sum::<Vector3<f64>>() / count
}

/// Returns the root mean square, or 0 for no values.
pub(crate) fn rms(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len().max(1) as f64;
    (values.map(|v| v * v).sum::<f64>() / count).sqrt()
}

/// Returns the median, or 0 for no values.
pub(crate) fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}
