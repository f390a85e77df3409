//! The robot's mechanics. Body axes: x forward, y left, z up; wheel 0 = left, 1 = right.

mod floor;
pub mod free;
mod legs;
mod pose;
mod rolling;
mod shaft;
mod stand;
mod start;
mod tilt;
mod upright;
mod variation;
mod wheels;

use crate::{attitude::Quaternion, joints::JOINTS, m3508::Friction, motion::Motion};
pub(crate) use floor::Floor;
use pose::Pose;
pub use start::Start;
pub(crate) use tilt::Stance;
use upright::Upright;
pub use variation::Variation;
pub(crate) use wheels::WHEEL_RADIUS_M;
use wheels::WheelTorques;

/// How the robot stands around the board.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PlantKind {
    /// The body is clamped, the wheels are in the air.
    #[default]
    Stand,
    /// The body stays upright and rolls on flat ground.
    Rolling,
}

/// A force on the body from outside.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OutsideForce {
    /// In world axes.
    pub force_n: [f64; 3],
    /// Where it acts, in body axes.
    pub at_m: [f64; 3],
}

/// What acts on the robot during one step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BodyInputs {
    /// Torque of each motor on its wheel, forward positive.
    pub wheel_nm: WheelTorques,
    pub wheel_friction: Friction,
    /// Torque of each joint's motor in joint coordinates.
    pub joint_nm: [f64; JOINTS],
    /// Dry friction of each joint's gear.
    pub joint_friction_nm: f64,
    pub floor: Floor,
    pub stance: Stance,
    /// What pushes the free robot.
    pub outside: Option<OutsideForce>,
}

pub(crate) enum Body {
    Upright(Upright),
}

impl Body {
    pub(crate) fn new(kind: PlantKind) -> Self {
        match kind {
            PlantKind::Stand => Self::Upright(Upright::stand()),
            PlantKind::Rolling => Self::Upright(Upright::rolling()),
        }
    }

    pub(crate) fn step(&mut self, inputs: &BodyInputs, dt_s: f64) {
        match self {
            Self::Upright(upright) => upright.step(inputs, dt_s),
        }
    }

    /// Wheel speeds in rad/s, forward positive.
    pub(crate) fn wheel_rps(&self) -> [f64; 2] {
        match self {
            Self::Upright(upright) => upright.wheel_rps(),
        }
    }

    /// Angles of the joints, rad.
    pub(crate) fn joint_pos_rad(&self) -> [f64; JOINTS] {
        match self {
            Self::Upright(upright) => upright.legs().pos_rad,
        }
    }

    /// Speeds of the joints, rad/s.
    pub(crate) fn joint_vel_rps(&self) -> [f64; JOINTS] {
        match self {
            Self::Upright(upright) => upright.legs().vel_rps,
        }
    }

    pub(crate) fn pose(&self) -> Pose {
        match self {
            Self::Upright(upright) => upright.pose(),
        }
    }

    /// Body → ENU earth.
    pub(crate) fn attitude(&self) -> Quaternion {
        match self {
            Self::Upright(upright) => upright.attitude(),
        }
    }

    /// Specific force and angular rate at the IMU, in body axes.
    pub(crate) fn motion(&self) -> Motion {
        match self {
            Self::Upright(upright) => upright.motion(),
        }
    }
}
