//! State and inputs of the free robot. Legs and wheels: 0 = left, 1 = right; hips: left front, left rear, right front,
//! right rear.

use crate::attitude::Quaternion;

/// Configuration and speeds. The world is ENU, body axes are x forward, y left, z up, and the body's origin is the middle
/// of the four hip axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreeState {
    /// The body's origin in the world.
    pub position_m: [f64; 3],
    /// Body → world, scalar first.
    pub attitude: Quaternion,
    /// Velocity of the body's origin, in world axes.
    pub velocity_mps: [f64; 3],
    /// Angular rate of the body, in body axes.
    pub rate_rps: [f64; 3],
    /// Hip angles: zero with the thigh level and outward, positive about −y.
    pub joint_rad: [f64; 4],
    /// Speeds of the hips.
    pub joint_rps: [f64; 4],
    /// Angle of each wheel against the shank that carries its motor, forward positive.
    pub wheel_rad: [f64; 2],
    /// Speed of each wheel against that shank.
    pub wheel_rps: [f64; 2],
}

/// A force on the body from outside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Push {
    /// In world axes.
    pub force_n: [f64; 3],
    /// Where it acts, in body axes.
    pub at_m: [f64; 3],
}

/// What acts on the robot during one step, beside gravity and ground. Torques beyond 500 N·m are cut, and what is not a
/// number counts as zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreeInputs {
    /// Torque of each motor on its wheel, forward positive. The shank that carries the motor takes the reaction.
    pub wheel_nm: [f64; 2],
    /// Torque of each hip motor on its thigh, in the hips' sense. The body takes the reaction.
    pub joint_nm: [f64; 4],
    /// Dry friction of each wheel's gear and bearing.
    pub wheel_dry_nm: f64,
    /// Viscous friction of each wheel.
    pub wheel_viscous_nm_per_rps: f64,
    /// Dry friction of each hip.
    pub joint_dry_nm: f64,
    /// Viscous friction of each hip.
    pub joint_viscous_nm_per_rps: f64,
    /// A push on the body.
    pub push: Option<Push>,
    /// Factor on the ground's friction: below 1 it is slippery.
    pub grip: f64,
}

impl Default for FreeInputs {
    fn default() -> Self {
        Self {
            wheel_nm: [0.0; 2],
            joint_nm: [0.0; 4],
            wheel_dry_nm: 0.0,
            wheel_viscous_nm_per_rps: 0.0,
            joint_dry_nm: 0.0,
            joint_viscous_nm_per_rps: 0.0,
            push: None,
            grip: 1.0,
        }
    }
}
