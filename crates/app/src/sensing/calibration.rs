//! Calibration: offsets and scales, and the start-up measurement of the gyro bias.

mod startup;
mod startup_gyro_bias;
mod temperature_gate;

pub(super) use startup::{CalibrationSample, StartupCalibration};

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

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: raw − bias is (1, 2, −3). The rows (2, 1, 0), (1, 3, −1) and (0, −1, 4) make 4, 10 and −14 of it.
    #[test]
    fn the_matrix_is_applied_after_the_offset() {
        let matrix = [[2.0, 1.0, 0.0], [1.0, 3.0, -1.0], [0.0, -1.0, 4.0]];
        let corrected = correct_by_matrix([11.0, -18.0, 27.0], [10.0, -20.0, 30.0], matrix);
        assert_eq!(corrected, [4.0, 10.0, -14.0]);
    }

    #[test]
    fn each_axis_has_its_own_offset_and_scale() {
        let corrected = correct([3.0, 4.0, 5.0], [1.0, 2.0, 3.0], [2.0, 0.5, -1.0]);
        assert_eq!(corrected, [4.0, 1.0, -2.0]);
    }
}
