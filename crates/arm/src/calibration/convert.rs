//! One format to the other, for the same pose of the arm.
//!
//! A servo with the offset `o` reports its angle less `o`. LeRobot's middle, 2047, is therefore at the angle `2047 + o`, which a plain
//! file calls `2048 + homing_offset`. Ranges move by `o`.

use super::{
    Calibration, CalibrationError, Format, JointCalibration, LEROBOT_MIDDLE, PLAIN_MIDDLE, Problem,
    STEPS_PER_TURN,
};

const LAST_STEP: i32 = STEPS_PER_TURN - 1;

impl Calibration {
    /// Returns the same arm in the other format. The servos need the offsets of that format then (`armctl calibrate --apply`).
    ///
    /// Nothing is lost on the way and back, except that a plain range up to 4096 comes back as one up to 4095: the same steps.
    pub fn to_format(&self, format: Format) -> Result<Self, CalibrationError> {
        if format == self.format {
            return Ok(self.clone());
        }
        let mut joints = Vec::new();
        for (name, joint) in &self.joints {
            let converted = match format {
                Format::Plain => to_plain(joint),
                Format::LeRobot => Ok(to_lerobot(joint)),
            };
            let joint = converted.map_err(|problem| CalibrationError::Joint {
                file: "the converted calibration".to_owned(),
                joint: name.clone(),
                problem,
            })?;
            joints.push((name.clone(), joint));
        }
        let converted = Self { format, joints };
        converted.check("the converted calibration")?;
        Ok(converted)
    }
}

fn to_plain(joint: &JointCalibration) -> Result<JointCalibration, Problem> {
    if joint.drive_mode != 0 {
        return Err(Problem::DriveMode);
    }
    let offset = joint.homing_offset;
    let homing_offset = LEROBOT_MIDDLE + offset - PLAIN_MIDDLE;
    if joint.is_whole_turn() {
        return Ok(JointCalibration {
            homing_offset,
            ..*joint
        });
    }
    let (from, to) = (joint.range_min + offset, joint.range_max + offset);
    if from < 0 || to > LAST_STEP {
        return Err(Problem::Seam { from, to });
    }
    Ok(JointCalibration {
        homing_offset,
        range_min: from,
        range_max: to,
        ..*joint
    })
}

fn to_lerobot(joint: &JointCalibration) -> JointCalibration {
    let offset = PLAIN_MIDDLE + joint.homing_offset - LEROBOT_MIDDLE;
    if joint.is_whole_turn() {
        return JointCalibration {
            homing_offset: offset,
            range_max: LAST_STEP,
            ..*joint
        };
    }
    JointCalibration {
        homing_offset: offset,
        range_min: joint.range_min - offset,
        range_max: joint.last_step() - offset,
        ..*joint
    }
}
