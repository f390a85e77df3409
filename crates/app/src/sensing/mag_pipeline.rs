//! IST8310 answers → calibrated [`MagState`].

use super::{
    calibration::correct_by_matrix,
    ist8310::{self, READ_LEN},
};
use crate::domain::{MagCalibration, MagState, MountingConfig, Orientation};

/// Why a sample was rejected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum MagSampleError {
    /// The sensor has no new measurement.
    NotReady,
    /// Beyond the range of the sensor.
    OutOfRange,
}

/// Checks, turns into the robot's axes and calibrates each sample.
#[derive(Clone, Debug)]
pub struct MagPipeline {
    mounting: MountingConfig,
    calibration: MagCalibration,
}

impl MagPipeline {
    pub const fn new(calibration: MagCalibration) -> Self {
        Self {
            mounting: MountingConfig {
                board: Orientation::XForwardZUp,
                mag: None,
            },
            calibration,
        }
    }

    /// Counts from the next sample on.
    pub fn set_calibration(&mut self, calibration: &MagCalibration) {
        self.calibration = *calibration;
    }

    /// Counts from the next sample on. Where nobody knows how the magnetometer sits beside the IMU, its axes are taken to be
    /// the IMU's.
    pub fn set_mounting(&mut self, mounting: &MountingConfig) {
        self.mounting = *mounting;
    }

    /// Takes the bytes read from `ist8310::READ_FROM`, whose measurement was started at `started_us`.
    pub fn process(
        &mut self,
        answer: &[u8; READ_LEN],
        started_us: u64,
    ) -> Result<MagState, MagSampleError> {
        let raw = ist8310::decode(answer).ok_or(MagSampleError::NotReady)?;
        let sensor_ut = raw.right_handed_ut().ok_or(MagSampleError::OutOfRange)?;
        let MountingConfig { board, mag } = self.mounting;
        let field_ut = board.turn(mag.unwrap_or_default().turn(sensor_ut));
        Ok(MagState {
            mag_ut: correct_by_matrix(
                field_ut,
                self.calibration.bias_ut,
                self.calibration.soft_iron,
            ),
            ts_us: ist8310::measured_at_us(started_us),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: 100, −200, 200 counts of 0.3 µT, y turned round, are 30, 60, 60 µT.
    #[test]
    fn the_field_is_calibrated_in_the_body_frame() {
        let mut pipeline = MagPipeline::new(MagCalibration {
            bias_ut: [10.0, 20.0, -40.0],
            soft_iron: [[1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 0.5]],
        });
        let answer = [0x01, 0x64, 0x00, 0x38, 0xFF, 0xC8, 0x00];
        let state = pipeline.process(&answer, 7).unwrap();
        for (got, expected) in state.mag_ut.iter().zip([20.0, 80.0, 50.0]) {
            assert!((got - expected).abs() < 1e-4, "{:?}", state.mag_ut);
        }
        // Half of 6 ms, and the order to measure takes 73 µs.
        assert_eq!(state.ts_us, 7 + 3_073);
    }

    /// 30, 60, 60 µT. Up is where the magnetometer's x points and forward where its z does, so its y points right: 60, −60,
    /// 30 on the IMU, whose x points left, y up and z forward.
    #[test]
    fn the_field_is_turned_by_both_mountings() {
        let mut pipeline = MagPipeline::new(MagCalibration::default());
        pipeline.set_mounting(&MountingConfig {
            board: Orientation::XLeftZForward,
            mag: Some(Orientation::XUpZForward),
        });
        let answer = [0x01, 0x64, 0x00, 0x38, 0xFF, 0xC8, 0x00];
        let [forward, left, up] = pipeline.process(&answer, 7).unwrap().mag_ut;
        assert!((forward - 30.0).abs() < 1e-4);
        assert!((left - 60.0).abs() < 1e-4);
        assert!((up + 60.0).abs() < 1e-4);
    }

    #[test]
    fn a_rejected_sample_is_named() {
        let mut pipeline = MagPipeline::new(MagCalibration::default());
        let stale = [0x00, 0x64, 0x00, 0x38, 0xFF, 0xC8, 0x00];
        let far = [0x01, 0xFF, 0x7F, 0x00, 0x00, 0x00, 0x00];
        assert_eq!(pipeline.process(&stale, 7), Err(MagSampleError::NotReady));
        assert_eq!(pipeline.process(&far, 7), Err(MagSampleError::OutOfRange));
    }
}
