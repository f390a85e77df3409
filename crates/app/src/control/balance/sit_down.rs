//! Sitting down: shorten the legs, let the body sink onto its front edge, let go.

use super::{
    law::{Goal, Ground, Law, Torques},
    measured::Measured,
    ramp::Ramp,
    reference::Wish,
};
use crate::domain::{BalanceProfile, WheelOdomConfig};

/// Rates in m/s and rad/s.
const LOWER_MPS: f32 = 0.15;
const SINK_RPS: f32 = 0.8;
/// The legs are short when they are this close to their shortest length, in m.
const CLOSE_M: f32 = 0.015;
/// The body sinks until it stays behind its reference by this, in rad: it lies on the ground.
const RESTS_RAD: f32 = 0.15;
/// Longest sinking in rad and longest time of it all in s.
const MOST_RAD: f32 = 1.0;
const GIVE_UP_S: f32 = 3.0;

/// Where sitting down has arrived.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SitDown {
    length: Ramp,
    pitch_rad: f32,
    elapsed_s: f32,
}

impl SitDown {
    pub const fn new(length: Ramp) -> Self {
        Self {
            length,
            pitch_rad: 0.0,
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
        let shortest_m = profile.limits.min_length_m;
        self.length.step(shortest_m, LOWER_MPS, dt_s);
        let is_short = self.length.value - shortest_m < CLOSE_M;
        if is_short {
            self.pitch_rad += SINK_RPS * dt_s;
        }
        let rests = self.pitch_rad - measured.tilt.pitch_rad > RESTS_RAD;
        if (is_short && rests) || self.pitch_rad > MOST_RAD || self.elapsed_s > GIVE_UP_S {
            return None;
        }
        let goal = Goal {
            wish: Wish::default(),
            length_m: self.length.value,
            length_mps: self.length.rate,
            roll_rad: 0.0,
            pitch_rad: self.pitch_rad,
            push_n: None,
            learn: false,
            ground: Ground::Touched,
        };
        Some(law.step(profile, odometry, measured, &goal, dt_s))
    }
}
