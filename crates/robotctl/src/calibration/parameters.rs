//! Reads and writes corrections by the names of the firmware's settings.

use nalgebra::{Matrix3, Vector3};

use super::{accel::AccelCorrection, mag::MagCorrection};
use crate::parameter_file::ParameterFile;

const AXES: [&str; 3] = ["x", "y", "z"];

impl AccelCorrection {
    /// Missing values are those of no correction.
    pub fn read(file: &ParameterFile) -> Self {
        let none = Self::NONE;
        let value = |name: String, otherwise: f64| file.get(&name).map_or(otherwise, f64::from);
        Self {
            bias_mps2: Vector3::from_fn(|axis, _| value(accel_bias(axis), none.bias_mps2[axis])),
            scale: Vector3::from_fn(|axis, _| value(accel_scale(axis), none.scale[axis])),
        }
    }

    pub fn write(&self, file: &mut ParameterFile) {
        for axis in 0..AXES.len() {
            file.set(&accel_bias(axis), self.bias_mps2[axis] as f32);
            file.set(&accel_scale(axis), self.scale[axis] as f32);
        }
    }
}

impl MagCorrection {
    /// Missing values are those of no correction.
    pub fn read(file: &ParameterFile) -> Self {
        let none = Self::none();
        let value = |name: String, otherwise: f64| file.get(&name).map_or(otherwise, f64::from);
        Self {
            bias_ut: Vector3::from_fn(|axis, _| value(mag_bias(axis), none.bias_ut[axis])),
            soft_iron: Matrix3::from_fn(|row, column| {
                value(soft_iron(row, column), none.soft_iron[(row, column)])
            }),
        }
    }

    pub fn write(&self, file: &mut ParameterFile) {
        for row in 0..AXES.len() {
            file.set(&mag_bias(row), self.bias_ut[row] as f32);
            for column in row..AXES.len() {
                file.set(
                    &soft_iron(row, column),
                    self.soft_iron[(row, column)] as f32,
                );
            }
        }
    }
}

fn accel_bias(axis: usize) -> String {
    format!("imu-calibration.accel-bias-{}-mps2", AXES[axis])
}

fn accel_scale(axis: usize) -> String {
    format!("imu-calibration.accel-scale-{}", AXES[axis])
}

fn mag_bias(axis: usize) -> String {
    format!("mag-calibration.bias-{}-ut", AXES[axis])
}

/// Returns the name of an element. The matrix is symmetric, so its lower half has the names of the upper one.
fn soft_iron(row: usize, column: usize) -> String {
    let (row, column) = (row.min(column), row.max(column));
    format!("mag-calibration.soft-iron-{}{}", AXES[row], AXES[column])
}
