//! BMI088 answers → calibrated [`ImuState`], and the duty of the heater.

mod freeze_check;
#[cfg(test)]
mod tests;

use self::freeze_check::FreezeCheck;
use super::{
    accel_delay::AccelDelay,
    bmi088::{self, ACCEL_READ, BufferMonitor, GYRO_READ, GyroRaw},
    calibration::{CalibrationSample, StartupCalibration, correct},
    heater::Heater,
    imu_sample_error::ImuSampleError,
    plausibility::Plausibility,
};
use crate::{
    domain::{
        CalibrationState, HeaterConfig, ImuCalibration, ImuRejects, ImuState, ImuStatus,
        Orientation,
    },
    math::{Vector3, vector},
};

/// Turns the answers of the BMI088 into calibrated samples in the robot's axes.
///
/// Each answer is checked for plausibility, scaled, rotated by the mounting and calibrated. The pipeline also controls the
/// heater, and measures the gyro bias once after boot.
///
/// ```
/// use robot_app::{
///     domain::{HeaterConfig, ImuCalibration},
///     sensing::{ImuPipeline, ImuSampleError},
/// };
///
/// let mut pipeline = ImuPipeline::new(ImuCalibration::default(), HeaterConfig::default());
///
/// // Level and at rest. z of the accelerometer is at byte 6: 2730 counts are 1 g at ±12 g.
/// let mut accel = [0; 20];
/// accel[6..8].copy_from_slice(&2_730_i16.to_le_bytes());
/// // The chip id of the gyro, and one frame in its buffer: 16 counts about z are 1 °/s.
/// let mut gyro = [0; 16];
/// gyro[1] = 0x0F;
/// gyro[7..9].copy_from_slice(&16_i16.to_le_bytes());
/// gyro[15] = 1;
/// let frames = [0, 0, 0, 0, 16, 0];
///
/// let imu = pipeline.process(&accel, &gyro, &frames, 5_000)?;
/// assert!((imu.accel_mps2[2] - 9.81).abs() < 0.01);
/// assert!((imu.gyro_dps[2] - 0.98).abs() < 0.01);
/// // The gyro's low-pass delays by 1.94 ms, and the newest frame is 0.5 ms old in the mean.
/// assert_eq!(imu.ts_us, 5_000 - 2_440);
///
/// // The accelerometer's sensor time (bytes 8 to 10) has not moved since.
/// let frozen = pipeline.process(&accel, &gyro, &frames, 10_000);
/// assert_eq!(frozen, Err(ImuSampleError::Frozen));
/// # Ok::<(), ImuSampleError>(())
/// ```
#[derive(Clone, Debug)]
pub struct ImuPipeline {
    mounting: Orientation,
    calibration: ImuCalibration,
    heater: Heater,
    startup: StartupCalibration,
    plausibility: Plausibility,
    accel_delay: AccelDelay,
    gyro_buffer: BufferMonitor,
    freeze_check: FreezeCheck,
    rejects: ImuRejects,
}

/// A plausible sample in physical units and the robot's axes, not yet calibrated.
#[derive(Clone, Copy, Debug)]
struct CheckedSample {
    accel_mps2: Vector3,
    gyro_dps: Vector3,
    gyro_clipped_ms: [u8; 3],
    temperature_c: Option<f32>,
    saturated: bool,
}

impl ImuPipeline {
    /// A pipeline before its first sample, for a board whose axes are those of the robot.
    pub fn new(calibration: ImuCalibration, heater: HeaterConfig) -> Self {
        Self {
            mounting: Orientation::default(),
            calibration,
            heater: Heater::new(heater),
            startup: StartupCalibration::default(),
            plausibility: Plausibility::default(),
            accel_delay: AccelDelay::default(),
            gyro_buffer: BufferMonitor::default(),
            freeze_check: FreezeCheck::default(),
            rejects: ImuRejects::default(),
        }
    }

    /// Changes the settings from the next sample on.
    pub fn set_config(&mut self, calibration: &ImuCalibration, heater: &HeaterConfig) {
        self.calibration = *calibration;
        self.heater.set_config(heater);
    }

    /// Sets how the axes of the IMU lie in the robot, from the next sample on. If that changes, the gyro bias is measured
    /// again.
    pub fn set_mounting(&mut self, mounting: Orientation) {
        if mounting != self.mounting {
            self.mounting = mounting;
            self.startup = StartupCalibration::default();
            self.accel_delay = AccelDelay::default();
        }
    }

    /// True once the gyro bias has been measured.
    pub fn calibrated(&self) -> bool {
        self.startup.status().state == CalibrationState::Done
    }

    /// Heater, calibration and counters, for diagnostics.
    pub fn status(&self) -> ImuStatus {
        ImuStatus {
            heater: *self.heater.status(),
            calibration: *self.startup.status(),
            rejects: self.rejects,
            gyro_buffer: self.gyro_buffer.status(),
        }
    }

    /// Duty of the heater, 0 … 1, until the next sample.
    pub const fn heater_duty(&self) -> f32 {
        self.heater.status().duty
    }

    /// True once after a sample that showed that the gyro's buffer is out of step. The caller then sends
    /// [`BUFFER_RESET`](bmi088::BUFFER_RESET).
    pub fn take_buffer_reset(&mut self) -> bool {
        self.gyro_buffer.take_reset()
    }

    /// Replaces [`process`](Self::process) when no answer came: the heater goes off.
    pub fn process_silence(&mut self, ts_us: u64) {
        self.heater.step(None, ts_us);
    }

    /// Processes the answers to [`ACCEL_READ`] and [`GYRO_READ`], read at `read_us`. `gyro_frames` is what
    /// [`BUFFER_READ`](bmi088::BUFFER_READ) brought after the echo of its address, or empty if the buffer was reset
    /// instead.
    ///
    /// # Errors
    /// A sample that is not plausible is rejected and counted by its reason.
    pub fn process(
        &mut self,
        accel_answer: &[u8; ACCEL_READ.len()],
        gyro_answer: &[u8; GYRO_READ.len()],
        gyro_frames: &[u8],
        read_us: u64,
    ) -> Result<ImuState, ImuSampleError> {
        let checked = self.check(accel_answer, gyro_answer, gyro_frames, read_us);
        let temperature_c = match &checked {
            Ok(raw) => raw.temperature_c,
            Err(error) => {
                self.count(*error);
                None
            }
        };
        self.heater.step(temperature_c, read_us);
        checked.map(|raw| self.calibrate(&raw, read_us))
    }

    fn check(
        &mut self,
        accel_answer: &[u8; ACCEL_READ.len()],
        gyro_answer: &[u8; GYRO_READ.len()],
        gyro_frames: &[u8],
        read_us: u64,
    ) -> Result<CheckedSample, ImuSampleError> {
        let accel = bmi088::decode_accel(accel_answer).ok_or(ImuSampleError::AccelAbsent)?;
        let gyro =
            bmi088::decode_gyro(gyro_answer, gyro_frames).ok_or(ImuSampleError::GyroAbsent)?;
        self.gyro_buffer.update(&gyro);
        let frozen = self.freeze_check.is_frozen(&accel, &gyro);
        let sample = self.plausibility.check(&accel, &gyro, read_us)?;
        if frozen {
            return Err(ImuSampleError::Frozen);
        }
        let outliers = &mut self.rejects.gyro_frames;
        *outliers = outliers.wrapping_add(sample.gyro.outliers.into());
        let gyro_dps = vector::scale(sample.gyro.mean_counts, GyroRaw::DPS_PER_COUNT);
        let clipped_ms = self.mounting.rotate(sample.gyro.clipped_ms.map(f32::from));
        Ok(CheckedSample {
            accel_mps2: self.mounting.rotate(accel.mps2()),
            gyro_dps: self.mounting.rotate(gyro_dps),
            gyro_clipped_ms: clipped_ms.map(|ms| ms.abs() as u8),
            temperature_c: accel.temperature.map(|temperature| temperature.celsius()),
            saturated: sample.saturated,
        })
    }

    fn calibrate(&mut self, raw: &CheckedSample, read_us: u64) -> ImuState {
        let calibration = &self.calibration;
        let (accel_mps2, saturated) =
            self.accel_delay
                .delay(raw.accel_mps2, raw.saturated, read_us);
        let accel_mps2 = correct(
            accel_mps2,
            calibration.accel_bias_mps2,
            calibration.accel_scale,
        );
        let sample = CalibrationSample {
            gyro_dps: raw.gyro_dps,
            stored_offset_dps: calibration.gyro_bias_dps,
            accel_mps2,
            temperature_c: raw.temperature_c,
            ts_us: read_us,
        };
        self.startup.feed(&sample, &self.heater);
        let gyro_bias_dps = self
            .startup
            .gyro_bias_dps()
            .unwrap_or(calibration.gyro_bias_dps);
        ImuState {
            accel_mps2,
            gyro_dps: correct(raw.gyro_dps, gyro_bias_dps, calibration.gyro_scale),
            gyro_bias_dps,
            temperature_c: self.heater.status().temperature_c,
            saturated,
            gyro_clipped_ms: raw.gyro_clipped_ms,
            ts_us: bmi088::interval_end_us(read_us),
        }
    }

    fn count(&mut self, error: ImuSampleError) {
        let rejects = &mut self.rejects;
        let count = match error {
            ImuSampleError::AccelAbsent | ImuSampleError::GyroAbsent => &mut rejects.absent,
            ImuSampleError::Frozen => &mut rejects.frozen,
            ImuSampleError::Implausible => &mut rejects.implausible,
            ImuSampleError::Saturated => &mut rejects.saturated,
        };
        *count = count.wrapping_add(1);
    }
}
