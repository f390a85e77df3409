//! The pose of one arm as that of another, which has other limits.

use std::collections::BTreeMap;

use crate::calibration::{Calibration, JointCalibration};

/// Turns the positions of a leader into targets of a follower. Both are calibrated; a joint that is at a third of the leader's
/// range goes to a third of the follower's.
#[derive(Clone, Debug)]
pub struct Follower {
    pairs: Vec<(String, JointCalibration, JointCalibration)>,
    missing: Vec<String>,
}

impl Follower {
    pub fn new(leader: &Calibration, follower: &Calibration) -> Self {
        let pair = |(name, of_leader): &(String, JointCalibration)| {
            let of_follower = follower.joint(name)?;
            Some((name.clone(), *of_leader, *of_follower))
        };
        let alone = leader
            .joints()
            .iter()
            .filter(|(name, _)| follower.joint(name).is_none());
        Self {
            pairs: leader.joints().iter().filter_map(pair).collect(),
            missing: alone.map(|(name, _)| name.clone()).collect(),
        }
    }

    /// Joints of the leader that the follower has not.
    pub fn missing(&self) -> &[String] {
        &self.missing
    }

    /// Returns the targets for positions of the leader. A joint without a position has no target.
    pub fn targets(&self, leader: &BTreeMap<String, i32>) -> BTreeMap<String, i32> {
        let target = |(name, from, to): &(String, JointCalibration, JointCalibration)| {
            let steps = leader.get(name)?;
            let part =
                f64::from(steps - from.range_min) / f64::from(from.range_max - from.range_min);
            // A leader with the other direction of turn counts the other way.
            let part = if from.drive_mode == to.drive_mode {
                part
            } else {
                1.0 - part
            };
            let travel = f64::from(to.range_max - to.range_min);
            let steps = f64::from(to.range_min) + part.clamp(0.0, 1.0) * travel;
            Some((name.clone(), steps.round() as i32))
        };
        self.pairs.iter().filter_map(target).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibration::Format;

    fn arm(range_min: i32, range_max: i32, drive_mode: u8) -> Calibration {
        let joint = JointCalibration {
            id: 1,
            drive_mode,
            homing_offset: 0,
            range_min,
            range_max,
        };
        Calibration::new(Format::LeRobot, vec![("pan".to_owned(), joint)]).unwrap()
    }

    #[test]
    fn a_part_of_one_range_is_the_same_part_of_the_other() {
        let follower = Follower::new(&arm(1000, 3000, 0), &arm(500, 1500, 0));
        let target = |steps| follower.targets(&BTreeMap::from([("pan".to_owned(), steps)]))["pan"];
        assert_eq!(
            [1000, 1500, 3000, 3100, 0].map(target),
            [500, 750, 1500, 1500, 500]
        );
        let mirrored = Follower::new(&arm(1000, 3000, 1), &arm(500, 1500, 0));
        assert_eq!(
            mirrored.targets(&BTreeMap::from([("pan".to_owned(), 1500)]))["pan"],
            1250
        );
        assert!(follower.targets(&BTreeMap::new()).is_empty());
    }
}
