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
mod variation;
mod wheels;

use crate::{m3508::Friction, motion::Motion};
pub(crate) use floor::Floor;
pub(crate) use legs::Legs;
use pose::Pose;
use rolling::Rolling;
use stand::Stand;
pub use start::Start;
pub(crate) use tilt::{Stance, Tilt};
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

pub(crate) enum Body {
    Stand(Stand),
    Rolling(Rolling),
}

impl Body {
    pub(crate) fn new(kind: PlantKind) -> Self {
        match kind {
            PlantKind::Stand => Self::Stand(Stand::default()),
            PlantKind::Rolling => Self::Rolling(Rolling::default()),
        }
    }

    pub(crate) fn step(
        &mut self,
        torques_nm: WheelTorques,
        friction: Friction,
        floor: Floor,
        dt_s: f64,
    ) {
        match self {
            Self::Stand(stand) => stand.step(torques_nm, friction, dt_s),
            Self::Rolling(rolling) => rolling.step(torques_nm, friction, floor, dt_s),
        }
    }

    /// Wheel speeds in rad/s, forward positive.
    pub(crate) fn wheel_rps(&self) -> [f64; 2] {
        match self {
            Self::Stand(stand) => stand.wheel_rps(),
            Self::Rolling(rolling) => rolling.wheel_rps(),
        }
    }

    pub(crate) fn pose(&self) -> Pose {
        match self {
            Self::Stand(_) => Pose::default(),
            Self::Rolling(rolling) => rolling.pose(),
        }
    }

    /// Specific force and angular rate at the IMU, in body axes.
    pub(crate) fn motion(&self) -> Motion {
        match self {
            Self::Stand(stand) => stand.motion(),
            Self::Rolling(rolling) => rolling.motion(),
        }
    }
}
