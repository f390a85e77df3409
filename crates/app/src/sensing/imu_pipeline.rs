//! BMI088 answers → calibrated [`ImuState`].

use super::{
    bmi088::{self, ACCEL_READ, GYRO_READ},
    calibration::{StartupGyroBias, correct},
};
use crate::domain::{ImuCalibration, ImuState};

/// Why a sample was rejected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum ImuSampleError {
    /// The accelerometer's answer has all bits alike.
    AccelAbsent,
    /// The gyro's answer lacks its chip id.
    GyroAbsent,
    /// The accelerometer's own clock stands still.
    AccelFrozen,
}

/// Checks, scales and calibrates each sample; finds the gyro offset once after boot.
///
/// Sensor axes are body axes: the board is mounted with its X forward and Z up.
#[derive(Clone, Debug)]
pub struct ImuPipeline {
    calibration: ImuCalibration,
    startup_bias: StartupGyroBias,
    last_sensor_time: Option<u32>,
    temperature_c: f32,
}

impl ImuPipeline {
    pub fn new(calibration: ImuCalibration) -> Self {
        Self {
            calibration,
            startup_bias: StartupGyroBias::new(),
            last_sensor_time: None,
            temperature_c: 0.0,
        }
    }

    /// True once the start-up gyro offset is known.
    pub fn calibrated(&self) -> bool {
        self.startup_bias.bias_dps().is_some()
    }

    /// Share of the start-up calibration that is done, 0 … 1.
    pub fn calibration_progress(&self) -> f32 {
        self.startup_bias.progress()
    }

    /// Takes the answers to `ACCEL_READ` and `GYRO_READ`, read at `ts_us`.
    pub fn process(
        &mut self,
        accel_answer: &[u8; ACCEL_READ.len()],
        gyro_answer: &[u8; GYRO_READ.len()],
        ts_us: u64,
    ) -> Result<ImuState, ImuSampleError> {
        let accel = bmi088::decode_accel(accel_answer).ok_or(ImuSampleError::AccelAbsent)?;
        let gyro = bmi088::decode_gyro(gyro_answer).ok_or(ImuSampleError::GyroAbsent)?;
        if self.last_sensor_time.replace(accel.sensor_time) == Some(accel.sensor_time) {
            return Err(ImuSampleError::AccelFrozen);
        }
        if let Some(temperature) = accel.temperature {
            self.temperature_c = temperature.celsius();
        }

        let calibration = &self.calibration;
        let accel_mps2 = correct(
            accel.mps2(),
            calibration.accel_bias_mps2,
            calibration.accel_scale,
        );
        let gyro_raw_dps = gyro.dps();
        self.startup_bias.feed(gyro_raw_dps, accel_mps2, ts_us);
        let gyro_bias_dps = self
            .startup_bias
            .bias_dps()
            .unwrap_or(calibration.gyro_bias_dps);
        Ok(ImuState {
            accel_mps2,
            gyro_dps: correct(gyro_raw_dps, gyro_bias_dps, calibration.gyro_scale),
            gyro_bias_dps,
            temperature_c: self.temperature_c,
            ts_us,
        })
    }
}
