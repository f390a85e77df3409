//! The robot's mechanics. Body axes: x forward, y left, z up; wheel 0 = left, 1 = right.

mod floor;
pub mod free;
mod legs;
mod loose;
mod pose;
mod rolling;
mod shaft;
mod shove;
mod stand;
mod tilt;
mod upright;
mod variation;
mod vibration;
mod wheels;

use robot_description::Robot;

use crate::{
    attitude::Quaternion,
    free::{FreeBody, FreeSetup, FreeState, Hold, Push},
    joints::JOINTS,
    m3508::Friction,
    motion::Motion,
};
pub(crate) use floor::Floor;
use loose::Loose;
pub(crate) use pose::Pose;
pub(crate) use tilt::Stance;
use upright::Upright;
pub use variation::Variation;
use wheels::WheelTorques;

/// How the robot stands around the board.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PlantKind {
    /// The body is clamped, the wheels are in the air.
    #[default]
    Stand,
    /// The body stays upright and rolls on flat ground.
    Rolling,
    /// Nothing holds the robot: it sits, stands, falls, flies.
    Free,
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
    pub outside: Option<Push>,
}

#[derive(Clone)]
pub(crate) enum Body {
    Upright(Box<Upright>),
    Free(Box<Loose>),
}

impl Body {
    /// A robot with the wheels of its file. The rest of the file, and `setup`, are for the free robot.
    pub(crate) fn new(kind: PlantKind, robot: &Robot, setup: &FreeSetup) -> Self {
        match kind {
            PlantKind::Stand => Self::Upright(Box::new(Upright::stand())),
            PlantKind::Rolling => Self::Upright(Box::new(Upright::rolling(&robot.wheels))),
            PlantKind::Free => Self::Free(Box::new(Loose::new(robot, setup))),
        }
    }

    pub(crate) fn step(&mut self, inputs: &BodyInputs, dt_s: f64) {
        match self {
            Self::Upright(upright) => upright.step(inputs, dt_s),
            Self::Free(loose) => loose.step(inputs, dt_s),
        }
    }

    /// Speeds of the wheels in the world in rad/s, forward positive.
    pub(crate) fn wheel_rps(&self) -> [f64; 2] {
        match self {
            Self::Upright(upright) => upright.wheel_rps(),
            Self::Free(loose) => loose.mechanics().wheel_abs_rps(),
        }
    }

    /// Speeds of the wheels against their motors in rad/s, forward positive.
    pub(crate) fn motor_rps(&self) -> [f64; 2] {
        match self {
            Self::Upright(upright) => upright.wheel_rps(),
            Self::Free(loose) => loose.mechanics().wheel_rel_rps(),
        }
    }

    /// Angles of the joints, rad.
    pub(crate) fn joint_pos_rad(&self) -> [f64; JOINTS] {
        match self {
            Self::Upright(upright) => upright.legs().pos_rad,
            Self::Free(loose) => loose.mechanics().joint_pos_rad(),
        }
    }

    /// Speeds of the joints, rad/s.
    pub(crate) fn joint_vel_rps(&self) -> [f64; JOINTS] {
        match self {
            Self::Upright(upright) => upright.legs().vel_rps,
            Self::Free(loose) => loose.mechanics().joint_vel_rps(),
        }
    }

    pub(crate) fn pose(&self) -> Pose {
        match self {
            Self::Upright(upright) => upright.pose(),
            Self::Free(loose) => loose.pose(),
        }
    }

    /// Body → ENU earth.
    pub(crate) fn attitude(&self) -> Quaternion {
        match self {
            Self::Upright(upright) => upright.attitude(),
            Self::Free(loose) => loose.attitude(),
        }
    }

    /// Specific force and angular rate at the IMU, in body axes.
    pub(crate) fn motion(&self) -> Motion {
        match self {
            Self::Upright(upright) => upright.motion(),
            Self::Free(loose) => loose.motion(),
        }
    }

    /// Puts the free robot into a state, held or not. No other robot minds.
    pub(crate) fn place(&mut self, state: &FreeState, hold: Hold) {
        if let Self::Free(loose) = self {
            loose.place(state, hold);
        }
    }

    /// The mechanics of the free robot.
    pub(crate) fn free(&self) -> Option<&FreeBody> {
        match self {
            Self::Upright(_) => None,
            Self::Free(loose) => Some(loose.mechanics()),
        }
    }
}
