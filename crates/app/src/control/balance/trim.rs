//! What it takes to stand still, learned while balancing: errors of the centre of mass, slopes, an oblique board.

use super::gains::INPUTS;
use crate::math::scalar;

/// Time constant in s of learning.
const TIME_S: f32 = 0.6;
/// Limits of what is learned.
const MAX_LEAN_RAD: f32 = 0.35;
const MAX_WHEEL_NM: f32 = 2.0;
const MAX_LEG_NM: f32 = 4.0;

/// The lean and the torques at which the robot stands still.
///
/// Each follows what the state feedback holds on average: then no error is left. The loop without them is stable with
/// any constant trim, and they are slower than it, so they do not disturb it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Trim {
    /// Lean of both legs in rad.
    pub lean_rad: f32,
    /// Torque of each wheel in N·m.
    pub wheel_nm: f32,
    /// Torque of the body on each leg in N·m.
    pub leg_nm: f32,
}

impl Trim {
    /// Learns from the mean lean less that which an acceleration takes, and from the torques of the state feedback
    /// beyond the present trim.
    pub fn learn(&mut self, lean_rad: f32, beyond_nm: [f32; INPUTS], dt_s: f32) {
        let share = dt_s / TIME_S;
        let [left_wheel, right_wheel, left_leg, right_leg] = beyond_nm;
        let follow = |trim: f32, change: f32, limit: f32| {
            scalar::clamp(trim + change * share, -limit, limit)
        };
        self.lean_rad = follow(self.lean_rad, lean_rad - self.lean_rad, MAX_LEAN_RAD);
        self.wheel_nm = follow(
            self.wheel_nm,
            0.5 * (left_wheel + right_wheel),
            MAX_WHEEL_NM,
        );
        self.leg_nm = follow(self.leg_nm, 0.5 * (left_leg + right_leg), MAX_LEG_NM);
    }
}
