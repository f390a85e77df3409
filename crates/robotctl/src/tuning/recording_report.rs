//! The robot's report on a recording (docs/tuning.md, `43`).

use robot_app::tuning::RecordingState;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RecordingReport {
    /// State of the recording; `Err` is a number that this tool does not know.
    pub state: Result<RecordingState, u8>,
    /// Samples of the IMU that the robot has sent.
    pub imu: u32,
    /// Samples of the magnetometer that the robot has sent.
    pub mag: u32,
}

impl RecordingReport {
    /// Parses the bytes after the command.
    pub(super) fn from_bytes([state, a, b, c, d, e, f]: [u8; 7]) -> Self {
        Self {
            state: RecordingState::from_code(state).ok_or(state),
            imu: u32::from_le_bytes([a, b, c, 0]),
            mag: u32::from_le_bytes([d, e, f, 0]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// In docs/tuning.md the recording ends early after 258 and 65,537 samples.
    #[test]
    fn the_documented_bytes_are_understood() {
        let expected = RecordingReport {
            state: Ok(RecordingState::CutShort),
            imu: 258,
            mag: 65_537,
        };
        let report = RecordingReport::from_bytes([2, 2, 1, 0, 1, 0, 1]);
        assert_eq!(report, expected);
        assert_eq!(
            RecordingReport::from_bytes([9, 0, 0, 0, 0, 0, 0]).state,
            Err(9)
        );
    }
}
