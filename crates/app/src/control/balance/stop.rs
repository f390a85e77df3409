//! The planned stop of a robot that has been pushed: its speed, its acceleration and with it the lean end at the same instant.

use crate::math::scalar;

/// A robot whose wheels are faster than wanted by so much, in m/s, has been pushed. Driving never gets there.
pub const PUSHED_MPS: f32 = 0.4;
/// Least deceleration in m/s² of a robot that brakes, and the one below which it no longer does.
const BRAKES_MPS2: f32 = 0.6;
const COASTS_MPS2: f32 = 0.3;
/// A push is over after this time in s. What lasts longer is a lean that has not been learned yet.
const LASTS_S: f32 = 1.2;
/// Largest deceleration in m/s² that is counted on: with little grip a robot that leans further brakes no harder.
const COUNTED_MPS2: f32 = 4.2;
/// Time in s that a stop takes.
const TAKES_S: f32 = 0.42;
/// The speed of a stop at its begin, as a share of that time and its deceleration.
const PART: f32 = 0.51;
/// Less time left than this counts as this: what is wrong in the end is put right no faster.
const LEAST_S: f32 = 0.13;
/// Time in s after the end of a stop in which what is wrong is put right.
const AFTER_S: f32 = 0.1;
/// Largest acceleration in m/s² of a plan, for which legs lean as far as they hold the hips up: what disturbs a stop asks for more.
const MOST_MPS2: f32 = 6.0;
/// Largest distance in m/s between the plan and the robot.
const NEAR_MPS: f32 = 0.3;

/// How the robot's hips move.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion {
    /// Speed in m/s.
    pub speed_mps: f32,
    /// Acceleration in m/s² that fits the legs' lean.
    pub accel_mps2: f32,
}

/// A stop that is planned.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stop {
    /// Time in s until its end.
    left_s: f32,
    /// Rate of the acceleration in m/s³.
    pub jerk_mps3: f32,
}

/// A robot that may have to stop.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pushed {
    /// It has been pushed and brakes.
    pub brakes: bool,
    /// Time in s for which it has been too fast or has braked.
    lasts_s: f32,
}

impl Pushed {
    /// It has been pushed and is still too fast.
    pub fn lasts(&self) -> bool {
        self.lasts_s > 0.0 && self.lasts_s <= LASTS_S
    }

    /// Begins a stop once a robot that was pushed and now brakes has just the time for it. Its wheels are too fast by `off_mps`.
    pub fn step(&mut self, off_mps: f32, wish_mps: f32, hips: &Motion, dt_s: f32) -> Option<Stop> {
        let too_fast = off_mps.abs() > PUSHED_MPS;
        if !too_fast && !self.brakes {
            self.lasts_s = 0.0;
            return None;
        }
        self.lasts_s += dt_s;
        if self.lasts_s > LASTS_S {
            self.brakes = false;
            return None;
        }
        let fast_mps = hips.speed_mps - wish_mps;
        let brakes_mps2 = if fast_mps < 0.0 {
            hips.accel_mps2
        } else {
            -hips.accel_mps2
        };
        if too_fast && brakes_mps2 > BRAKES_MPS2 {
            self.brakes = true;
        }
        if brakes_mps2 < COASTS_MPS2 {
            self.brakes = false;
        }
        let begins =
            self.brakes && fast_mps.abs() < PART * TAKES_S * scalar::min(brakes_mps2, COUNTED_MPS2);
        begins.then(|| {
            self.brakes = false;
            Stop {
                left_s: TAKES_S,
                jerk_mps3: 0.0,
            }
        })
    }
}

impl Stop {
    /// Moves the plan on by `dt_s` beside the robot's `hips`, along the gentlest way to the wished speed. Returns false when it is over.
    pub fn step(&mut self, plan: &mut Motion, wish_mps: f32, hips: &Motion, dt_s: f32) -> bool {
        let left_s = scalar::max(self.left_s, LEAST_S);
        let behind_mps = wish_mps - plan.speed_mps;
        // The least square of the fourth derivative on the way to a state in which nothing changes.
        let snap_mps4 = ((60.0 * behind_mps / left_s - 36.0 * plan.accel_mps2) / left_s
            - 9.0 * self.jerk_mps3)
            / left_s;
        self.jerk_mps3 += snap_mps4 * dt_s;
        let accel_mps2 = plan.accel_mps2 + self.jerk_mps3 * dt_s;
        plan.accel_mps2 = scalar::clamp(accel_mps2, -MOST_MPS2, MOST_MPS2);
        let ahead_mps = plan.speed_mps + plan.accel_mps2 * dt_s - hips.speed_mps;
        plan.speed_mps = hips.speed_mps + scalar::clamp(ahead_mps, -NEAR_MPS, NEAR_MPS);
        self.left_s -= dt_s;
        self.left_s > -AFTER_S
    }
}

#[cfg(test)]
mod tests;
