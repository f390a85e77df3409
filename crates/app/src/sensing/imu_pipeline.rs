//! BMI088 answers → calibrated [`ImuState`].

use super::{
    bmi088::{self, ACCEL_READ, AccelRaw, GYRO_READ, GyroRaw},
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
    /// The accelerometer's own clock stands still, or no count has changed for longer than noise allows.
    Frozen,
}

/// What a frozen sensor repeats.
#[derive(Clone, Copy, Debug)]
struct RawSample {
    accel_counts: [i16; 3],
    gyro_counts: [i16; 3],
    sensor_time: u32,
}

/// Samples that may be alike in all six counts: at rest noise moves at least one of them nearly every time.
const MAX_REPEATS: u8 = 10;

/// Checks, scales and calibrates each sample; finds the gyro offset once after boot.
///
/// Sensor axes are body axes: the board is mounted with its X forward and Z up.
#[derive(Clone, Debug)]
pub struct ImuPipeline {
    calibration: ImuCalibration,
    startup_bias: StartupGyroBias,
    last: Option<RawSample>,
    repeats: u8,
    temperature_c: f32,
}

impl ImuPipeline {
    pub fn new(calibration: ImuCalibration) -> Self {
        Self {
            calibration,
            startup_bias: StartupGyroBias::new(),
            last: None,
            repeats: 0,
            temperature_c: 0.0,
        }
    }

    /// True once the start-up gyro offset is known.
    pub fn calibrated(&self) -> bool {
        self.startup_bias.bias_dps().is_some()
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
        if self.frozen(&accel, &gyro) {
            return Err(ImuSampleError::Frozen);
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

    fn frozen(&mut self, accel: &AccelRaw, gyro: &GyroRaw) -> bool {
        let sample = RawSample {
            accel_counts: accel.counts,
            gyro_counts: gyro.counts,
            sensor_time: accel.sensor_time,
        };
        let Some(last) = self.last.replace(sample) else {
            return false;
        };
        let alike =
            last.accel_counts == sample.accel_counts && last.gyro_counts == sample.gyro_counts;
        self.repeats = if alike {
            self.repeats.saturating_add(1)
        } else {
            0
        };
        last.sensor_time == sample.sensor_time || self.repeats > MAX_REPEATS
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// BMI088 answers at rest, level, by the datasheet: 1 g is 2730 counts at ±12 g, temperature 0x0120 shifted = 24.125 °C.
    fn answers(index: u32) -> ([u8; 20], [u8; 9]) {
        let mut accel = [0; 20];
        let ripple = (index % 3) as u8;
        accel[2] = ripple;
        accel[6..8].copy_from_slice(&2_730i16.to_le_bytes());
        accel[8..11].copy_from_slice(&(index * 128).to_le_bytes()[..3]);
        accel[18..20].copy_from_slice(&[0x01, 0x20]);
        let mut gyro = [0; 9];
        gyro[1] = 0x0F;
        gyro[7..9].copy_from_slice(&164i16.to_le_bytes());
        (accel, gyro)
    }

    #[test]
    fn counts_become_physical_units() {
        let mut pipeline = ImuPipeline::new(ImuCalibration::default());
        let (accel, gyro) = answers(3);
        let state = pipeline.process(&accel, &gyro, 5_000).unwrap();
        assert!((state.accel_mps2[2] - 9.806_65).abs() < 0.01);
        assert!((state.gyro_dps[2] - 10.01).abs() < 0.01);
        assert_eq!(state.temperature_c, 24.125);
        assert_eq!(state.ts_us, 5_000);
    }

    /// By hand: (9.806 − 0.306) · 2 = 19 m/s²; until the offset is measured the stored one counts, (10.01 − 1.01) · 0.5.
    #[test]
    fn stored_offsets_and_scales_are_applied() {
        let mut pipeline = ImuPipeline::new(ImuCalibration {
            accel_bias_mps2: [0.0, 0.0, 0.306],
            accel_scale: [1.0, 1.0, 2.0],
            gyro_bias_dps: [0.0, 0.0, 1.01],
            gyro_scale: [1.0, 1.0, 0.5],
        });
        let (accel, gyro) = answers(3);
        let state = pipeline.process(&accel, &gyro, 5_000).unwrap();
        assert!((state.accel_mps2[2] - 19.0).abs() < 0.01);
        assert!((state.gyro_dps[2] - 4.5).abs() < 0.01);
        assert_eq!(state.gyro_bias_dps[2], 1.01);
    }

    #[test]
    fn a_still_second_takes_the_offset_out() {
        let mut pipeline = ImuPipeline::new(ImuCalibration::default());
        let mut last = ImuState::default();
        for index in 1..=210u32 {
            let (accel, mut gyro) = answers(index);
            gyro[7..9].copy_from_slice(&(16 + (index % 2) as i16).to_le_bytes());
            last = pipeline
                .process(&accel, &gyro, u64::from(index) * 5_000)
                .unwrap();
        }
        assert!(pipeline.calibrated());
        assert!((last.gyro_bias_dps[2] - 16.5 / 16.384).abs() < 0.01);
        assert!(last.gyro_dps[2].abs() < 0.05);
    }

    #[test]
    fn an_absent_sensor_is_named() {
        let mut pipeline = ImuPipeline::new(ImuCalibration::default());
        let (accel, gyro) = answers(1);
        let mut process = |accel: &[u8; 20], gyro: &[u8; 9]| pipeline.process(accel, gyro, 5_000);
        assert_eq!(
            process(&[0xFF; 20], &gyro),
            Err(ImuSampleError::AccelAbsent)
        );
        assert_eq!(
            process(&[0x00; 20], &gyro),
            Err(ImuSampleError::AccelAbsent)
        );
        assert_eq!(process(&accel, &[0xFF; 9]), Err(ImuSampleError::GyroAbsent));
        assert_eq!(process(&accel, &[0x00; 9]), Err(ImuSampleError::GyroAbsent));
    }

    #[test]
    fn a_frozen_sensor_is_noticed() {
        let mut pipeline = ImuPipeline::new(ImuCalibration::default());
        let (accel, gyro) = answers(1);
        assert!(pipeline.process(&accel, &gyro, 5_000).is_ok());
        let stopped_clock = pipeline.process(&accel, &gyro, 10_000);
        assert_eq!(stopped_clock, Err(ImuSampleError::Frozen));

        let mut pipeline = ImuPipeline::new(ImuCalibration::default());
        let results: Vec<bool> = (1..=20u32)
            .map(|index| {
                let (mut accel, gyro) = answers(index);
                accel[2] = 7;
                let ts_us = u64::from(index) * 5_000;
                pipeline.process(&accel, &gyro, ts_us).is_ok()
            })
            .collect();
        assert!(results[..8].iter().all(|good| *good));
        assert!(!results[19]);
    }
}
