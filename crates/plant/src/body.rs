//! The robot's mechanics. Body axes: x forward, y left, z up; wheel 0 = left, 1 = right.

mod legs;
mod rolling;
mod stand;
mod tilt;

use crate::{bmi088::Motion, m3508::Friction, world::PlantKind};
pub(crate) use legs::Legs;
use rolling::Rolling;
use stand::Stand;
pub(crate) use tilt::{Stance, Tilt};

/// Wheel radius in m.
pub(crate) const WHEEL_RADIUS_M: f64 = 0.06;
/// Distance between the wheels in m.
pub(crate) const TRACK_M: f64 = 0.42;
/// Wheel with reflected rotor inertia, kg·m²: an assumption, published values spread widely (hardware.md 11).
const WHEEL_INERTIA_KGM2: f64 = 0.0105;

/// Torque of each motor on its wheel, right-hand about the body's y axis (positive drives forward).
pub(crate) type WheelTorques = [f64; 2];

/// What the wheels roll on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Floor {
    Clean,
    Slippery,
}

impl Floor {
    /// Most the ground gives per newton of load. Assumed: rubber on a clean floor; on wet ice.
    fn grip(self) -> f64 {
        match self {
            Self::Clean => 0.8,
            Self::Slippery => 0.05,
        }
    }
}

/// Where the body is, in the ENU earth frame and in its own axes.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Pose {
    pub x_m: f64,
    pub y_m: f64,
    /// From east, counter-clockwise.
    pub yaw_rad: f64,
    /// Way along the body's own forward axis so far, backward counted negative.
    pub path_m: f64,
    /// Forward speed of the body.
    pub vx_mps: f64,
    pub wz_rps: f64,
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

    /// What a sensor in the body feels.
    pub(crate) fn motion(&self) -> Motion {
        match self {
            Self::Stand(stand) => stand.motion(),
            Self::Rolling(rolling) => rolling.motion(),
        }
    }
}

/// Speed after one step of a shaft under a driving torque, with friction that stops it but never turns it round.
fn turn_shaft(rps: f64, torque_nm: f64, friction: Friction, inertia_kgm2: f64, dt_s: f64) -> f64 {
    let driven = rps + (torque_nm - friction.viscous_nm_per_rps * rps) * dt_s / inertia_kgm2;
    let brake = friction.dry_nm * dt_s / inertia_kgm2;
    if driven.abs() <= brake {
        0.0
    } else {
        driven - brake.copysign(driven)
    }
}
