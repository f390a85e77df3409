//! What is known of the robot at one moment.

use crate::{PolicyDescription, attitude::QuatWxyz};

/// State of the robot, joints in the policy's order and sense ([`JointMapping`](crate::JointMapping)).
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    /// Attitude, body to world.
    pub attitude: QuatWxyz,
    /// Angular velocity in rad/s in axes of the body, as a gyro gives it. Rates in axes of the world become such by
    /// [`QuatWxyz::body_from_world`].
    pub body_rates_rps: [f32; 3],
    /// Velocity of the body in m/s in its own axes. `None` on a robot that does not know it.
    pub linear_velocity_mps: Option<[f32; 3]>,
    /// Angles in rad, wheels included.
    pub joint_pos_rad: Vec<f32>,
    /// Speeds in rad/s, wheels included.
    pub joint_vel_rps: Vec<f32>,
}

impl Reading {
    /// Returns a level robot at rest with its joints at their default angles.
    pub fn at_default_pose(policy: &PolicyDescription) -> Self {
        let angles = policy.joints.iter().map(|joint| joint.default_rad);
        Self {
            attitude: QuatWxyz::LEVEL,
            body_rates_rps: [0.0; 3],
            linear_velocity_mps: None,
            joint_pos_rad: angles.collect(),
            joint_vel_rps: vec![0.0; policy.joints.len()],
        }
    }
}

/// What the pilot wishes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Commands {
    /// Velocity forward in m/s.
    pub forward_mps: f32,
    /// Velocity to the left in m/s.
    pub left_mps: f32,
    /// Turn rate to the left in rad/s.
    pub yaw_rps: f32,
}

impl Commands {
    /// Returns forward, left, turn, each held within its range. What is no number stays so, for the observer to refuse it.
    pub(super) fn within(self, ranges: &[[f32; 2]; 3]) -> [f32; 3] {
        let wishes = [self.forward_mps, self.left_mps, self.yaw_rps];
        std::array::from_fn(|n| {
            let [low, high] = ranges[n];
            if wishes[n].is_finite() {
                wishes[n].clamp(low, high)
            } else {
                wishes[n]
            }
        })
    }
}
