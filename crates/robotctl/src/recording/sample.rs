//! A sample of one sensor.

use nalgebra::Vector3;

/// The sensors that can be calibrated from a recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sensor {
    /// Specific force in m/s² in the body frame (x forward, y left, z up).
    Accelerometer,
    /// Magnetic field in µT in the body frame.
    Magnetometer,
}

impl Sensor {
    /// Returns the names of a table's columns.
    fn columns(self) -> [&'static str; 3] {
        match self {
            Self::Accelerometer => ["ax", "ay", "az"],
            Self::Magnetometer => ["mx", "my", "mz"],
        }
    }

    /// Returns the place of the vector in the messages of `/diag`.
    pub(super) fn diagnostics_field(self) -> &'static str {
        match self {
            Self::Accelerometer => "/sensors/imu/accel_mps2",
            Self::Magnetometer => "/sensors/mag/mag_ut",
        }
    }

    /// Says how the header of a table must look.
    pub(super) fn expected_header(self) -> String {
        let [x, y, z] = self.columns();
        let unit = match self {
            Self::Accelerometer => "m/s²",
            Self::Magnetometer => "µT",
        };
        format!("the header must be `t,{x},{y},{z}` (s and {unit})")
    }
}

/// One measurement. Its numbers are finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    pub t_s: f64,
    pub value: Vector3<f64>,
}
