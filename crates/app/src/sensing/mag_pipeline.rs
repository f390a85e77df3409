//! IST8310 answers → calibrated [`MagState`].

use super::{
    calibration::correct_by_matrix,
    ist8310::{self, READ_LEN},
};
use crate::domain::{MagCalibration, MagState};

/// Why a sample was rejected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum MagSampleError {
    /// The sensor has no new measurement.
    NotReady,
    /// Beyond the range of the sensor.
    OutOfRange,
}

/// Checks, turns into the body frame and calibrates each sample.
#[derive(Clone, Debug)]
pub struct MagPipeline {
    calibration: MagCalibration,
}

impl MagPipeline {
    pub const fn new(calibration: MagCalibration) -> Self {
        Self { calibration }
    }

    /// Counts from the next sample on.
    pub fn set_calibration(&mut self, calibration: &MagCalibration) {
        self.calibration = *calibration;
    }

    /// Takes the bytes read from `ist8310::READ_FROM`, whose measurement was started at `started_us`.
    pub fn process(
        &mut self,
        answer: &[u8; READ_LEN],
        started_us: u64,
    ) -> Result<MagState, MagSampleError> {
        let raw = ist8310::decode(answer).ok_or(MagSampleError::NotReady)?;
        let field_ut = raw.body_ut().ok_or(MagSampleError::OutOfRange)?;
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

    /// By hand: 100, −200, 200 counts of 0.3 µT, raw y pointing right, are 30, 60, 60 µT in the body frame.
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

    #[test]
    fn a_rejected_sample_is_named() {
        let mut pipeline = MagPipeline::new(MagCalibration::default());
        let stale = [0x00, 0x64, 0x00, 0x38, 0xFF, 0xC8, 0x00];
        let far = [0x01, 0xFF, 0x7F, 0x00, 0x00, 0x00, 0x00];
        assert_eq!(pipeline.process(&stale, 7), Err(MagSampleError::NotReady));
        assert_eq!(pipeline.process(&far, 7), Err(MagSampleError::OutOfRange));
    }
}
