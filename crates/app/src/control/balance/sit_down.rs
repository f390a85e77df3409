//! Sitting down: fold the legs, let the body sink onto its front edge while the wheels brake it, let go.

use super::{
    law::{Goal, Law, Torques},
    measured::Measured,
    ramp::Ramp,
    tip::tip,
};
use crate::domain::{BalanceProfile, WheelOdomConfig};

/// Rates in m/s and rad/s.
const LOWER_MPS: f32 = 0.2;
const SINK_RPS: f32 = 2.0;
/// The legs are folded when they are this close to their shortest length, in m.
const CLOSE_M: f32 = 0.005;
/// Push in N with which a leg is folded onto its stops.
const SINK_N: f32 = -15.0;
/// From this pitch in rad on the body falls by itself: a few degrees are left, and safety takes more for a fall.
const LET_GO_RAD: f32 = 0.62;
/// It lies on the ground if it stays behind this reference of its lean in rad.
const MOST_RAD: f32 = 0.8;
/// Longest time of it all in s.
const GIVE_UP_S: f32 = 3.0;

/// Where sitting down has arrived.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SitDown {
    length: Ramp,
    /// Lean in rad while the body sinks.
    lean_rad: Option<f32>,
    elapsed_s: f32,
}

impl SitDown {
    pub const fn new(length: Ramp) -> Self {
        Self {
            length,
            lean_rad: None,
            elapsed_s: 0.0,
        }
    }

    /// Torques of this tick, or `None` once the robot sits.
    pub fn step(
        &mut self,
        law: &mut Law,
        profile: &BalanceProfile,
        odometry: &WheelOdomConfig,
        measured: &Measured,
        dt_s: f32,
    ) -> Option<Torques> {
        self.elapsed_s += dt_s;
        if self.elapsed_s > GIVE_UP_S {
            return None;
        }
        let limits = &profile.limits;
        if let Some(lean_rad) = &mut self.lean_rad {
            *lean_rad += SINK_RPS * dt_s;
            let sinks = *lean_rad < MOST_RAD && measured.tilt.pitch_rad < LET_GO_RAD;
            return sinks.then(|| tip(limits, measured, *lean_rad, SINK_RPS, SINK_N));
        }
        self.length.step(limits.fold_length_m, LOWER_MPS, dt_s);
        if self.length.value - limits.fold_length_m < CLOSE_M {
            self.lean_rad = Some(measured.mean_lean_rad());
        }
        let goal = Goal::upright(self.length);
        Some(law.step(profile, odometry, measured, &goal, dt_s))
    }
}
