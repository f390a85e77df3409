//! The legs carry the body: height, roll, and the load of a turn.

use super::{measured::Measured, ramp::Ramp, stop::PUSHED_MPS, upright::Upright};
use crate::{domain::MassModel, kinematics::Leg, math::scalar};

pub const GRAVITY_MPS2: f32 = 9.806_65;
/// Natural frequency in rad/s and damping of the body on its legs.
const HEAVE_RPS: f32 = 14.0;
const HEAVE_DAMPING: f32 = 0.8;
/// The same for roll.
const ROLL_RPS: f32 = 12.0;
const ROLL_DAMPING: f32 = 0.8;
/// The same for a leg in the air, which carries only its wheel.
const AIR_RPS: f32 = 45.0;
const AIR_DAMPING: f32 = 0.8;
/// Largest length in m by which one leg is longer and the other shorter in the air.
const MAX_LEVEL_M: f32 = 0.05;
/// Largest push of the legs that counts, as a share of that of standing.
const MAX_SHARE: f32 = 5.0;
/// Time constant in s of learning the load.
const LOAD_TIME_S: f32 = 1.0;
/// A shorter leg in m counts as this one.
const LEAST_LENGTH_M: f32 = 0.05;
/// From so much before the hips' stops, in m, the legs are held back by this in N/m, as of their length in some time in s. A leg that
/// hits its stops throws the wheel up.
const HELD_BEFORE_STOPS_M: f32 = 0.015;
const STOP_N_PER_M: f32 = 4_000.0;
const STOP_AHEAD_S: f32 = 0.05;
/// Shares of the weight for a body that is too fast by 1 m/s and leans by 1 rad. Its legs push less by the first while the lean
/// shrinks, and by the second once the wheels are fast; they push more by the third while it leans back and brakes. All shares and
/// speeds here were found with those of `catch.rs`, for `robots/fivebar.toml`.
const EASE: f32 = 0.56;
const FAST_EASE: f32 = 1.0;
const BRAKE: f32 = 0.38;
/// Largest share by which they push less, and more.
const MOST_EASING: f32 = 0.9;
const MOST_BRAKING: f32 = 0.47;
/// Share by which they push more, for grip, while the lean still grows at this rate in rad/s or more. All of it counts for a body
/// that is too fast by the sum of both speeds in m/s, nothing below the first.
const GRIP: f32 = 0.67;
const GRIP_MPS: f32 = 0.5;
const GRIP_SPAN_MPS: f32 = 0.5;
const GRIP_RPS: f32 = 3.1;
/// Wheels are fast from this speed in m/s on, all of them after this span.
const FAST_MPS: f32 = 2.0;
const FAST_SPAN_MPS: f32 = 0.6;
/// Largest share of its load that a body may have too little or too much.
const MAX_LOAD_ERROR: f32 = 0.6;
/// The difference between the legs' pushes is learned as by this natural frequency of roll in rad/s.
const LEARN_ROLL_RPS: f32 = 6.0;
/// Largest learned difference between the legs' pushes, as a share of the load.
const MAX_ROLL_SHARE: f32 = 0.3;

/// What the legs shall do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stance {
    /// Height of the hips above the axles in m, which is the legs' length as long as they do not lean.
    pub length: Ramp,
    /// Roll in rad.
    pub roll_rad: f32,
    /// Sideways acceleration to the left in m/s².
    pub sideways_mps2: f32,
    /// The legs' present push as a share of that of standing.
    pub share: f32,
    /// How much too fast the axles move, in m/s.
    pub off_mps: f32,
    /// Lean in rad with which the robot would not accelerate.
    pub lean_rad: f32,
    /// Torque of both legs less that of both wheels in N·m, which leans the legs forward.
    pub across_nm: f32,
    /// Longest leg in m that the hips' ranges allow at the legs' angle.
    pub longest_m: f32,
}

impl Stance {
    /// Share of its weight by which the body of a pushed robot is pushed less or more. While its lean grows the wheels need grip
    /// to get ahead of it. Once they are faster, what the legs push would only speed it up. When it leans back it brakes as hard as
    /// they push.
    fn easing(&self, measured: &Measured, upright: &Upright) -> f32 {
        if self.off_mps.abs() < PUSHED_MPS {
            return 0.0;
        }
        let body_mps = self.off_mps + measured.length_m() * upright.cos * measured.mean_lean_rps();
        let brakes = -body_mps * (measured.mean_lean_rad() - self.lean_rad);
        if brakes > 0.0 {
            return scalar::min(BRAKE * brakes, MOST_BRAKING);
        }
        let fast = (measured.speed_mps.abs() - FAST_MPS) / FAST_SPAN_MPS;
        let fast = scalar::clamp(fast, 0.0, 1.0);
        let forward = if body_mps < 0.0 { -1.0 } else { 1.0 };
        let leans = scalar::clamp(forward * measured.mean_lean_rps() / GRIP_RPS, -1.0, 1.0);
        let struck = scalar::clamp((body_mps.abs() - GRIP_MPS) / GRIP_SPAN_MPS, 0.0, 1.0);
        let grip = GRIP * struck * scalar::max(leans, 0.0);
        let ease = (EASE * scalar::max(-leans, 0.0) + FAST_EASE * fast) * brakes;
        scalar::clamp(grip + ease, -MOST_EASING, MOST_BRAKING)
    }
}

/// Pushes of the legs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Support {
    /// Load in N beyond that of the robot's file, and the push of the right leg beyond that of the left.
    load_n: f32,
    roll_n: f32,
}

impl Support {
    /// Push of both legs as a share of that of standing.
    pub fn share(&self, mass: &MassModel, push_n: f32) -> f32 {
        let standing_n = mass.carried_kg * GRAVITY_MPS2 + self.load_n;
        scalar::clamp(push_n / scalar::max(standing_n, 1.0), -MAX_SHARE, MAX_SHARE)
    }

    /// Pushes of the left and the right leg in N.
    pub fn step(
        &mut self,
        mass: &MassModel,
        track_m: f32,
        stance: &Stance,
        measured: &Measured,
        learning: bool,
        dt_s: f32,
    ) -> [f32; 2] {
        let length_m = measured.length_m();
        let stiffness = mass.carried_kg * HEAVE_RPS * HEAVE_RPS;
        let upright = Upright::new(stance.length.value, stance.longest_m, measured);
        let both_n = self.both_n(mass, stance, measured, &upright);
        let height_m = length_m + mass.carried_up_m;
        let inertia = mass.roll_kgm2 + mass.carried_kg * height_m * height_m;
        let tilt = &measured.tilt;
        // Where the robot turns, the centrifugal force tips it the way its weight does, and by more.
        let pull_mps2 = GRAVITY_MPS2 + tilt.yaw_rps * tilt.yaw_rps * height_m;
        let weight_nm = mass.carried_kg * pull_mps2 * height_m;
        let roll_error = tilt.roll_rad - stance.roll_rad;
        let roll_nm = (inertia * ROLL_RPS * ROLL_RPS + weight_nm) * roll_error
            + 2.0 * ROLL_DAMPING * ROLL_RPS * inertia * tilt.roll_rps
            + mass.carried_kg * stance.sideways_mps2 * height_m;
        let roll_n = roll_nm / track_m;
        if learning {
            let load_n = mass.carried_kg * GRAVITY_MPS2;
            let part = dt_s / LOAD_TIME_S;
            let most_n = MAX_LOAD_ERROR * load_n;
            self.load_n = scalar::clamp(
                self.load_n + stiffness * upright.sag_m * part,
                -most_n,
                most_n,
            );
            let most_n = MAX_ROLL_SHARE * load_n;
            let beyond_n = LEARN_ROLL_RPS * LEARN_ROLL_RPS * inertia * roll_error / track_m;
            self.roll_n = scalar::clamp(self.roll_n + beyond_n * part, -most_n, most_n);
        }
        let right_n = roll_n + self.roll_n * stance.share * (pull_mps2 / GRAVITY_MPS2);
        [0.5 * both_n - right_n, 0.5 * both_n + right_n]
    }

    /// Push of both legs in N that keeps the hips at their height, however the legs lean.
    fn both_n(
        &self,
        mass: &MassModel,
        stance: &Stance,
        measured: &Measured,
        upright: &Upright,
    ) -> f32 {
        let stiffness = mass.carried_kg * HEAVE_RPS * HEAVE_RPS;
        let damping = 2.0 * HEAVE_DAMPING * HEAVE_RPS * mass.carried_kg;
        let Upright { sin, cos, .. } = *upright;
        let length_m = measured.length_m();
        let weight_n = mass.carried_kg * GRAVITY_MPS2 + self.load_n;
        let carried_n = weight_n * (1.0 + stance.easing(measured, upright));
        let heave_n = stiffness * upright.sag_m + damping * (stance.length.rate - upright.rise_mps);
        let across_n = stance.across_nm / scalar::max(length_m, LEAST_LENGTH_M);
        let up_n = carried_n + heave_n + across_n * sin;
        let soon_m = length_m + STOP_AHEAD_S * measured.length_mps();
        let beyond_m = soon_m + HELD_BEFORE_STOPS_M - stance.longest_m;
        up_n / cos - STOP_N_PER_M * scalar::max(beyond_m, 0.0)
    }

    /// Pushes in N in the air: the legs follow this length, and both wheels are level.
    pub fn in_air(mass: &MassModel, track_m: f32, length: &Ramp, measured: &Measured) -> [f32; 2] {
        let right_m = 0.5 * level_m(track_m, measured);
        let [left, right] = &measured.legs;
        [
            in_air_n(mass, left, length.value - right_m, length.rate),
            in_air_n(mass, right, length.value + right_m, length.rate),
        ]
    }

    /// Push in N of the left leg and of the right one if it alone is in the air: its wheel is level with the other one.
    pub fn one_in_air(mass: &MassModel, track_m: f32, measured: &Measured) -> [f32; 2] {
        let right_m = level_m(track_m, measured);
        let [left, right] = &measured.legs;
        [
            in_air_n(mass, left, right.length_m - right_m, right.length_mps),
            in_air_n(mass, right, left.length_m + right_m, left.length_mps),
        ]
    }
}

/// Length in m by which the right leg is longer while both wheels are level.
fn level_m(track_m: f32, measured: &Measured) -> f32 {
    // With its right side down the right hip is lower.
    let right_m = -track_m * measured.tilt.roll_rad;
    scalar::clamp(right_m, -2.0 * MAX_LEVEL_M, 2.0 * MAX_LEVEL_M)
}

/// Push in N of a leg in the air that follows a length and its rate.
fn in_air_n(mass: &MassModel, leg: &Leg, length_m: f32, length_mps: f32) -> f32 {
    let stiffness = mass.axle_kg * AIR_RPS * AIR_RPS;
    let damping = 2.0 * AIR_DAMPING * AIR_RPS * mass.axle_kg;
    stiffness * (length_m - leg.length_m) + damping * (length_mps - leg.length_mps)
}

#[cfg(test)]
mod tests;
