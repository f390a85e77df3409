//! Which servo is which joint, where its home is, and how far it may go.
//!
//! Two kinds of file say so, and their joints mean different things:
//!
//! | | [`Format::Plain`]: `servo_config.json`, `left_arm.json`, `right_arm.json` | [`Format::LeRobot`] |
//! |---|---|---|
//! | fields of a joint | `id`, `homing_offset`, `range_min`, `range_max` | the same and `drive_mode` |
//! | `homing_offset` | home is at 2048 + offset; the servo's own offset is 0 | stored in the servo, which reports its angle less this; home is at 2047 |
//! | ranges | in steps as the servo reports them, up to 4096 | the same, up to 4095 |

mod convert;
mod error;
mod file;
mod travel;

pub use error::{CalibrationError, Problem};
pub use travel::{Travel, TravelError};

/// Steps of a turn.
pub const STEPS_PER_TURN: i32 = 4096;
/// Middle of a turn: home of a [plain](Format::Plain) file with an offset of 0.
const PLAIN_MIDDLE: i32 = 2048;
/// Where LeRobot puts the middle of a joint.
const LEROBOT_MIDDLE: i32 = 2047;
/// The largest offset that a servo can store.
pub const LARGEST_OFFSET: i32 = 2047;

/// The kind of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// The offset is in the file alone.
    Plain,
    /// The offset is in the servo too.
    LeRobot,
}

impl Format {
    /// Steps at which an offset of 0 has its home.
    fn middle(self) -> i32 {
        match self {
            Self::Plain => PLAIN_MIDDLE,
            Self::LeRobot => LEROBOT_MIDDLE,
        }
    }
}

/// One joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct JointCalibration {
    pub id: u8,
    /// LeRobot's: 1 is a joint that turns the other way. 0 in a plain file.
    pub drive_mode: u8,
    pub homing_offset: i32,
    pub range_min: i32,
    pub range_max: i32,
}

/// The joints of an arm, in the order of their file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Calibration {
    format: Format,
    joints: Vec<(String, JointCalibration)>,
}

impl Calibration {
    /// Takes joints; ids, offsets and ranges are checked.
    pub fn new(
        format: Format,
        joints: Vec<(String, JointCalibration)>,
    ) -> Result<Self, CalibrationError> {
        let calibration = Self { format, joints };
        calibration.check("the calibration")?;
        Ok(calibration)
    }

    /// The six joints of an SO-101 with ids 1 to 6, as they are before they are calibrated: the whole turn, home in its middle.
    pub fn so101() -> Self {
        let names = [
            "shoulder_pan",
            "shoulder_lift",
            "elbow_flex",
            "wrist_flex",
            "wrist_roll",
            "gripper",
        ];
        let joint = |id| JointCalibration {
            id,
            drive_mode: 0,
            homing_offset: 0,
            range_min: 0,
            range_max: STEPS_PER_TURN - 1,
        };
        let joints = names
            .into_iter()
            .zip(1..)
            .map(|(name, id)| (name.to_owned(), joint(id)));
        Self {
            format: Format::Plain,
            joints: joints.collect(),
        }
    }

    pub fn format(&self) -> Format {
        self.format
    }

    pub fn joints(&self) -> &[(String, JointCalibration)] {
        &self.joints
    }

    pub fn joint(&self, name: &str) -> Option<&JointCalibration> {
        let found = self.joints.iter().find(|(joint, _)| joint == name);
        found.map(|(_, joint)| joint)
    }

    /// Steps of a joint's home, within its range.
    pub(crate) fn home(&self, joint: &JointCalibration) -> i32 {
        let home = match self.format {
            Format::Plain => PLAIN_MIDDLE + joint.homing_offset,
            Format::LeRobot => LEROBOT_MIDDLE,
        };
        home.clamp(joint.range_min, joint.last_step())
    }

    /// The offset that the servo itself has to have.
    pub(crate) fn servo_offset(&self, joint: &JointCalibration) -> i32 {
        match self.format {
            Format::Plain => 0,
            Format::LeRobot => joint.homing_offset,
        }
    }
}

impl JointCalibration {
    /// The highest step that the joint may be told: a range of 0 to 4096 is a whole turn, which ends at 4095.
    pub(crate) fn last_step(&self) -> i32 {
        self.range_max.min(STEPS_PER_TURN - 1)
    }

    /// True if it may turn all around.
    fn is_whole_turn(&self) -> bool {
        self.range_min == 0 && self.last_step() == STEPS_PER_TURN - 1
    }
}

#[cfg(test)]
mod tests;
