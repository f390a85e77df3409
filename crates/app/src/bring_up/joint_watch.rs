//! Which way a joint is being turned: what one compares with the model in the first step.

use crate::domain::JointFeedback;

/// Less than this since the last look is noise.
const STILL_RAD: f32 = 0.02;

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Turn {
    #[default]
    Still,
    /// The angle grows.
    Forward,
    Back,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct JointReading {
    /// Angle in joint coordinates.
    pub pos_mrad: i32,
    /// Since the last look.
    pub turn: Turn,
}

/// Remembers the angles of the last look.
#[derive(Clone, Debug, Default)]
pub struct JointWatch {
    last_rad: [f32; 4],
}

impl JointWatch {
    /// Call a few times a second. A first look at a joint off zero shows a turn.
    pub fn look(&mut self, joints: &[JointFeedback; 4]) -> [JointReading; 4] {
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

    /// The second joint stands there.
    fn at(pos_rad: f32) -> [JointFeedback; 4] {
        let mut joints = [JointFeedback::default(); 4];
        joints[1].pos_rad = pos_rad;
        joints
    }

    #[test]
    fn a_fiftieth_of_a_radian_is_noise() {
        for (moved_rad, turn) in [
            (0.02, Turn::Still),
            (-0.02, Turn::Still),
            (0.021, Turn::Forward),
            (-0.021, Turn::Back),
        ] {
            let reading = JointWatch::default().look(&at(moved_rad))[1];
            assert_eq!(reading.turn, turn, "{moved_rad}");
        }
    }

    #[test]
    fn a_turned_joint_shows_which_way() {
        let mut watch = JointWatch::default();
        let turns: Vec<_> = [0.0, 0.3, 0.31, 0.1]
            .map(|pos_rad| watch.look(&at(pos_rad))[1])
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
