//! Shows which way a joint is turned by hand in the first step, to compare it with the model.

use crate::domain::JointFeedback;

/// A smaller change since the last update is noise.
const STILL_RAD: f32 = 0.02;

/// Direction of a joint's motion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Turn {
    /// The joint does not move.
    #[default]
    Still,
    /// The angle increases.
    Forward,
    /// The angle decreases.
    Back,
}

/// Angle and motion of one joint.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct JointReading {
    /// Angle in joint coordinates, in mrad.
    pub pos_mrad: i32,
    /// Motion since the last update.
    pub turn: Turn,
}

/// Compares the joints' angles with those of the last update.
#[derive(Clone, Debug, Default)]
pub struct JointMotionMonitor {
    last_rad: [f32; 4],
}

impl JointMotionMonitor {
    /// Takes new angles; call it a few times a second. In the first call a joint off zero appears to turn.
    pub fn update(&mut self, joints: &[JointFeedback; 4]) -> [JointReading; 4] {
        let mut readings = [JointReading::default(); 4];
        for ((reading, last_rad), joint) in readings.iter_mut().zip(&mut self.last_rad).zip(joints)
        {
            let moved_rad = joint.pos_rad - *last_rad;
            *last_rad = joint.pos_rad;
            reading.pos_mrad = (joint.pos_rad * 1_000.0) as i32;
            reading.turn = if moved_rad > STILL_RAD {
                Turn::Forward
            } else if moved_rad < -STILL_RAD {
                Turn::Back
            } else {
                Turn::Still
            };
        }
        readings
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Joint angles with the second joint at `pos_rad`.
    fn at(pos_rad: f32) -> [JointFeedback; 4] {
        let mut joints = [JointFeedback::default(); 4];
        joints[1].pos_rad = pos_rad;
        joints
    }

    #[test]
    fn motion_below_a_fiftieth_of_a_radian_is_noise() {
        for (moved_rad, turn) in [
            (0.02, Turn::Still),
            (-0.02, Turn::Still),
            (0.021, Turn::Forward),
            (-0.021, Turn::Back),
        ] {
            let reading = JointMotionMonitor::default().update(&at(moved_rad))[1];
            assert_eq!(reading.turn, turn, "{moved_rad}");
        }
    }

    #[test]
    fn a_turned_joint_shows_its_direction() {
        let mut watch = JointMotionMonitor::default();
        let turns: Vec<_> = [0.0, 0.3, 0.31, 0.1]
            .map(|pos_rad| watch.update(&at(pos_rad))[1])
            .map(|reading| (reading.pos_mrad, reading.turn))
            .to_vec();
        assert_eq!(
            turns,
            [
                (0, Turn::Still),
                (300, Turn::Forward),
                (310, Turn::Still),
                (100, Turn::Back)
            ]
        );
    }
}
