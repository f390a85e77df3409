//! IST8310 answers → calibrated [`MagState`].

use super::{
    calibration::correct_by_matrix,
    ist8310::{self, READ_LEN},
};
use crate::domain::{MagCalibration, MagState, MountingConfig, Orientation};

/// Why a magnetometer sample was rejected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum MagSampleError {
    /// The sensor has no new measurement.
    NotReady,
    /// The field is beyond the range of the sensor.
    OutOfRange,
}

/// Turns the answers of the IST8310 into calibrated samples in the robot's axes.
///
/// ```
/// use robot_app::{
///     domain::{MagCalibration, MountingConfig, Orientation},
///     sensing::{MagPipeline, MagSampleError},
/// };
///
/// let mut pipeline = MagPipeline::new(MagCalibration::default());
/// pipeline.set_mounting(&MountingConfig {
///     board: Orientation::XForwardZUp,
///     mag: Some(Orientation::XForwardZUp),
/// });
/// // Status "ready", then 100, −200 and 200 counts of 0.3 µT. The sensor's y axis is inverted.
/// let mag = pipeline.process(&[0x01, 0x64, 0x00, 0x38, 0xFF, 0xC8, 0x00], 20_000)?;
/// for (got, expected) in mag.mag_ut.iter().zip([30.0, 60.0, 60.0]) {
///     assert!((got - expected).abs() < 1e-3);
/// }
/// // The middle of the measurement: 73 µs to order it and half of 6 ms.
/// assert_eq!(mag.ts_us, 23_073);
/// # Ok::<(), MagSampleError>(())
/// ```
#[derive(Clone, Debug)]
pub struct MagPipeline {
    mounting: MountingConfig,
    calibration: MagCalibration,
}

impl MagPipeline {
    /// A pipeline for a magnetometer whose axes are those of the robot.
    pub const fn new(calibration: MagCalibration) -> Self {
        Self {
            mounting: MountingConfig {
                board: Orientation::XForwardZUp,
                mag: None,
            },
            calibration,
        }
    }

    /// Changes the calibration from the next sample on.
    pub fn set_calibration(&mut self, calibration: &MagCalibration) {
        self.calibration = *calibration;
    }

    /// Changes the mounting from the next sample on. A magnetometer whose mounting is unknown gets the axes of the IMU.
    pub fn set_mounting(&mut self, mounting: &MountingConfig) {
        self.mounting = *mounting;
    }

    /// Processes the bytes read from [`ist8310::READ_FROM`]. The measurement was started at `started_us`.
    ///
    /// # Errors Without a new measurement, or with a field beyond the range of the sensor.
    pub fn process(
        &mut self,
        answer: &[u8; READ_LEN],
        started_us: u64,
    ) -> Result<MagState, MagSampleError> {
        let raw = ist8310::decode(answer).ok_or(MagSampleError::NotReady)?;
        let sensor_ut = raw.right_handed_ut().ok_or(MagSampleError::OutOfRange)?;
        let MountingConfig { board, mag } = self.mounting;
        let field_ut = board.rotate(mag.unwrap_or_default().rotate(sensor_ut));
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

    /// By hand: 100, −200, 200 counts of 0.3 µT with y inverted are 30, 60, 60 µT.
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
        // 73 µs to order the measurement, and half of 6 ms.
        assert_eq!(state.ts_us, 7 + 3_073);
    }

    /// The sensor measures 30, 60, 60 µT. Its x points up on the IMU, its z forward, and so its y to the right: 60,
    /// −60, 30 on the IMU, whose own x points left, y up and z forward.
    #[test]
    fn the_field_is_rotated_by_both_mountings() {
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
    fn the_reason_of_a_rejection_is_reported() {
        let mut pipeline = MagPipeline::new(MagCalibration::default());
        let stale = [0x00, 0x64, 0x00, 0x38, 0xFF, 0xC8, 0x00];
        let far = [0x01, 0xFF, 0x7F, 0x00, 0x00, 0x00, 0x00];
        assert_eq!(pipeline.process(&stale, 7), Err(MagSampleError::NotReady));
        assert_eq!(pipeline.process(&far, 7), Err(MagSampleError::OutOfRange));
    }
}
