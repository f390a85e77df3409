//! The pose of one arm as that of another, which has other limits.

use std::collections::BTreeMap;

use crate::calibration::{Calibration, JointCalibration};

/// Turns the positions of a leader into targets of a follower. Both are calibrated; a joint that is at a third of the leader's
/// range goes to a third of the follower's.
#[derive(Clone, Debug)]
pub struct Follower {
    pairs: Vec<Pair>,
    missing: Vec<String>,
}

/// A joint of both arms.
#[derive(Clone, Debug)]
struct Pair {
    name: String,
    from: JointCalibration,
    to: JointCalibration,
    /// The last target.
    target: Option<i32>,
    /// The leader's joint did not answer, and the follower's is not yet where that one is now.
    is_behind: bool,
}

impl Follower {
    pub fn new(leader: &Calibration, follower: &Calibration) -> Self {
        let pair = |(name, from): &(String, JointCalibration)| {
            Some(Pair {
                name: name.clone(),
                from: *from,
                to: *follower.joint(name)?,
                target: None,
                is_behind: false,
            })
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

    /// Returns the targets for positions of the leader. A joint without a position has no target, and goes by `catch_up` steps a
    /// call once it has one again: its leader may be far away by then.
    pub fn targets(
        &mut self,
        leader: &BTreeMap<String, i32>,
        catch_up: i32,
    ) -> BTreeMap<String, i32> {
        let pairs = self.pairs.iter_mut();
        let target = |pair: &mut Pair| Some((pair.name.clone(), pair.next(leader, catch_up)?));
        pairs.filter_map(target).collect()
    }
}

impl Pair {
    fn next(&mut self, leader: &BTreeMap<String, i32>, catch_up: i32) -> Option<i32> {
        let Some(steps) = leader.get(&self.name) else {
            self.is_behind = true;
            return None;
        };
        let wanted = self.same_place(*steps);
        let target = match self.target {
            Some(last) if self.is_behind => last + (wanted - last).clamp(-catch_up, catch_up),
            _ => wanted,
        };
        self.is_behind &= target != wanted;
        self.target = Some(target);
        Some(target)
    }

    fn same_place(&self, steps: i32) -> i32 {
        let (from, to) = (&self.from, &self.to);
        let part = f64::from(steps - from.range_min) / f64::from(from.range_max - from.range_min);
        // A leader with the other direction of turn counts the other way.
        let part = if from.drive_mode == to.drive_mode {
            part
        } else {
            1.0 - part
        };
        let travel = f64::from(to.range_max - to.range_min);
        let steps = f64::from(to.range_min) + part.clamp(0.0, 1.0) * travel;
        steps.round() as i32
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
        let mut follower = Follower::new(&arm(1000, 3000, 0), &arm(500, 1500, 0));
        assert_eq!(
            [1000, 1500, 3000, 3100, 0].map(|steps| follower.targets(&pan(steps), 1)["pan"]),
            [500, 750, 1500, 1500, 500]
        );
        let mut mirrored = Follower::new(&arm(1000, 3000, 1), &arm(500, 1500, 0));
        assert_eq!(mirrored.targets(&pan(1500), 1)["pan"], 1250);
        assert!(follower.targets(&BTreeMap::new(), 1).is_empty());
    }

    #[test]
    fn a_joint_whose_leader_was_missing_catches_up_slowly() {
        let same = arm(0, 4000, 0);
        let mut follower = Follower::new(&same, &same);
        assert_eq!(follower.targets(&pan(1000), 50)["pan"], 1000);
        assert!(follower.targets(&BTreeMap::new(), 50).is_empty());
        let leader = [1120, 1140, 1140, 1400];
        assert_eq!(
            leader.map(|steps| follower.targets(&pan(steps), 50)["pan"]),
            [1050, 1100, 1140, 1400]
        );
    }

    fn pan(steps: i32) -> BTreeMap<String, i32> {
        BTreeMap::from([("pan".to_owned(), steps)])
    }
}
