//! IST8310 answers → calibrated [`MagState`].

use super::{
    calibration::correct,
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

    /// Takes the bytes read from `ist8310::READ_FROM` at `ts_us`.
    pub fn process(
        &mut self,
        answer: &[u8; READ_LEN],
        ts_us: u64,
    ) -> Result<MagState, MagSampleError> {
        let raw = ist8310::decode(answer).ok_or(MagSampleError::NotReady)?;
        let field_ut = raw.body_ut().ok_or(MagSampleError::OutOfRange)?;
        Ok(MagState {
            mag_ut: correct(field_ut, self.calibration.bias_ut, self.calibration.scale),
            ts_us,
        })
    }
}
