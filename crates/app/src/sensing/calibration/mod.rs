//! Sensor offsets and scales.

mod startup;
mod startup_gyro_bias;
mod temperature_gate;

pub(super) use startup::{Sample, StartupCalibration};

use crate::math::{Vector3, vector};

/// (raw − bias) · scale, axis by axis.
pub(super) fn correct(raw: Vector3, bias: Vector3, scale: Vector3) -> Vector3 {
    vector::multiply(vector::sub(raw, bias), scale)
}

/// matrix · (raw − bias).
pub(super) fn correct_by_matrix(raw: Vector3, bias: Vector3, matrix: [Vector3; 3]) -> Vector3 {
    let offset_free = vector::sub(raw, bias);
    matrix.map(|row| vector::dot(row, offset_free))
}
