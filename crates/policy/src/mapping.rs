//! Which motor is which joint of the policy.

/// Numbers that are no mapping.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NotAMapping {
    /// A motor is named twice, or does not exist.
    #[error(
        "{motors:?} does not name each motor from 0 to {last} once: give the motor's number of each joint of the policy"
    )]
    Motors {
        /// What was given.
        motors: Vec<usize>,
        /// Number of the last motor.
        last: usize,
    },
    /// A direction is neither 1 nor −1.
    #[error("{directions:?} are not {count} directions: give 1 or -1 for each joint of the policy")]
    Directions {
        /// What was given.
        directions: Vec<i8>,
        /// How many joints there are.
        count: usize,
    },
}

/// The motor of each joint of the policy, and whether both count in the same sense.
///
/// Joint `i` of the policy is motor `motors[i]`, and `value_of_joint = direction[i] · value_of_motor` for angles, speeds and
/// torques.
#[derive(Clone, Debug, PartialEq)]
pub struct JointMapping {
    motors: Vec<usize>,
    directions: Vec<f32>,
}

impl JointMapping {
    /// Takes the motor's number of each joint of the policy, and 1 or −1 for each.
    ///
    /// # Errors
    /// The motors are no permutation of 0, 1, 2 …, or a direction is neither 1 nor −1.
    pub fn new(motors: Vec<usize>, directions: &[i8]) -> Result<Self, NotAMapping> {
        let count = motors.len();
        let mut sorted = motors.clone();
        sorted.sort_unstable();
        if !sorted.into_iter().eq(0..count) {
            let last = count.saturating_sub(1);
            return Err(NotAMapping::Motors { motors, last });
        }
        if directions.len() != count || directions.iter().any(|it| it.abs() != 1) {
            let directions = directions.to_vec();
            return Err(NotAMapping::Directions { directions, count });
        }
        let directions = directions.iter().map(|it| f32::from(*it)).collect();
        Ok(Self { motors, directions })
    }

    /// Returns the motor's number of each joint of the policy.
    pub fn motors(&self) -> &[usize] {
        &self.motors
    }

    /// Returns 1 or −1 for each joint of the policy.
    pub fn directions(&self) -> &[f32] {
        &self.directions
    }

    /// Brings values of the motors into order and sense of the policy: `joints[i] = direction[i] · motors[motor[i]]`.
    ///
    /// # Panics
    /// A slice has another length than the mapping.
    pub fn policy_from_motors(&self, motors: &[f32], joints: &mut [f32]) {
        assert_eq!([motors.len(), joints.len()], [self.motors.len(); 2]);
        for ((joint, motor), direction) in joints.iter_mut().zip(&self.motors).zip(&self.directions)
        {
            *joint = direction * motors[*motor];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_of_motors_come_into_order_and_sense_of_the_policy() {
        let mapping = JointMapping::new(vec![2, 0, 1], &[1, -1, 1]).unwrap();
        let mut joints = [0.0; 3];
        mapping.policy_from_motors(&[10.0, 11.0, 12.0], &mut joints);
        assert_eq!(joints, [12.0, -10.0, 11.0]);
    }

    #[test]
    fn a_motor_of_two_joints_is_refused() {
        for motors in [vec![0, 0, 1], vec![1, 2, 3]] {
            let error = JointMapping::new(motors, &[1; 3]).unwrap_err();
            assert!(matches!(error, NotAMapping::Motors { .. }), "{error}");
        }
        for directions in [&[1, 1][..], &[1, 0, 1]] {
            let error = JointMapping::new(vec![0, 1, 2], directions).unwrap_err();
            assert!(matches!(error, NotAMapping::Directions { .. }), "{error}");
        }
    }
}
