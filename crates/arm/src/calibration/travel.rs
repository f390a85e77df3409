//! How far a joint goes while somebody moves it by hand.

use super::{Format, JointCalibration, LARGEST_OFFSET, STEPS_PER_TURN};

/// A joint that moved less was forgotten.
const LEAST_TRAVEL: i32 = 50;

/// The travel of a joint, counted from the pose that was called its middle. It knows the seam between 4095 and 0, as it follows
/// the joint in small steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Travel {
    /// Angle of the shaft at the middle, without the servo's offset.
    middle: i32,
    last: i32,
    /// Steps from the middle: now, and the farthest on both sides.
    now: i32,
    least: i32,
    most: i32,
}

/// Why a joint is not calibrated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TravelError {
    #[error(
        "moved by {steps} steps only: move it to both of its stops while the ranges are recorded"
    )]
    NotMoved { steps: i32 },
    #[error(
        "goes {below} steps below and {above} above the pose that was called its middle, so that the seam between 4095 and 0 \
         would lie in its travel: put the joint into the middle of its travel first, and calibrate again"
    )]
    NotTheMiddle { below: i32, above: i32 },
    #[error(
        "its travel crosses the seam between 4095 and 0, at which a servo jumps by a turn: calibrate with --format lerobot, which \
         moves the seam away, or take the horn off its shaft and put it on half a turn further"
    )]
    Seam,
    #[error(
        "its middle needs an offset of {offset}, and a servo stores 2047 at the most: move the joint by some steps and calibrate \
         again, or put the horn on its shaft one tooth further"
    )]
    Offset { offset: i32 },
}

impl Travel {
    /// Starts at the middle pose. `position` is what the servo reports, `offset` what it has stored.
    pub fn new(position: i32, offset: i32) -> Self {
        let middle = (position + offset).rem_euclid(STEPS_PER_TURN);
        Self {
            middle,
            last: middle,
            now: 0,
            least: 0,
            most: 0,
        }
    }

    /// Takes the next position. Between two of them a joint goes less than half a turn.
    pub fn follow(&mut self, position: i32, offset: i32) {
        let angle = (position + offset).rem_euclid(STEPS_PER_TURN);
        let half = STEPS_PER_TURN / 2;
        let step = (angle - self.last + half).rem_euclid(STEPS_PER_TURN) - half;
        self.last = angle;
        self.now = self.now.saturating_add(step);
        self.least = self.least.min(self.now);
        self.most = self.most.max(self.now);
    }

    /// Steps below and above the middle so far.
    pub fn reach(&self) -> (i32, i32) {
        (-self.least, self.most)
    }

    /// Returns the joint's calibration. `is_whole_turn` says that it has no stops, as an SO-101's wrist_roll.
    pub fn finish(
        &self,
        id: u8,
        format: Format,
        is_whole_turn: bool,
    ) -> Result<JointCalibration, TravelError> {
        let homing_offset = self.middle - format.middle();
        if homing_offset > LARGEST_OFFSET {
            return Err(TravelError::Offset {
                offset: homing_offset,
            });
        }
        let (range_min, range_max) = if is_whole_turn {
            (0, STEPS_PER_TURN - 1)
        } else {
            self.range(format)?
        };
        Ok(JointCalibration {
            id,
            drive_mode: 0,
            homing_offset,
            range_min,
            range_max,
        })
    }

    fn range(&self, format: Format) -> Result<(i32, i32), TravelError> {
        let steps = self.most - self.least;
        if steps < LEAST_TRAVEL {
            return Err(TravelError::NotMoved { steps });
        }
        let middle = match format {
            Format::Plain => self.middle,
            Format::LeRobot => format.middle(),
        };
        let (min, max) = (middle + self.least, middle + self.most);
        if min >= 0 && max < STEPS_PER_TURN {
            return Ok((min, max));
        }
        Err(match format {
            Format::Plain => TravelError::Seam,
            Format::LeRobot => TravelError::NotTheMiddle {
                below: -self.least,
                above: self.most,
            },
        })
    }
}
