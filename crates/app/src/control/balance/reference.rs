//! What the robot shall follow: speed and yaw rate that it can reach without falling, and the place where it rests.

use super::stop::{Motion, Pushed, Stop};
use crate::math::scalar;

/// Acceleration limit in m/s²: the lean that it takes is far from falling, and little friction is enough for it.
const MAX_ACCEL_MPS2: f32 = 2.5;
/// Natural frequency in rad/s, well damped, with which the reference follows the wish. The robot leans as fast.
const FOLLOW_RPS: f32 = 6.0;
/// Acceleration limit of the turn in rad/s².
const MAX_YAW_RPSS: f32 = 10.0;
/// Largest sideways acceleration in m/s² in a turn.
const MAX_SIDEWAYS_MPS2: f32 = 3.0;
/// Largest distance in m from the place that the robot holds.
const MAX_DISTANCE_M: f32 = 0.05;
/// A robot that is asked to drive faster than this, in m/s, plans no stop.
const STANDS_MPS: f32 = 0.125;
/// A speed error in m/s beyond which the robot lets go of its place.
const LETS_GO_MPS: f32 = 0.25;
/// Time constant in s of letting go.
const LET_GO_S: f32 = 0.1;
/// Largest error of the heading in rad that is held.
const MAX_YAW_ERROR_RAD: f32 = 0.3;

/// What is wished for.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wish {
    pub speed_mps: f32,
    pub yaw_rps: f32,
}

/// The reference and the distances from it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reference {
    pub speed_mps: f32,
    pub accel_mps2: f32,
    pub yaw_rps: f32,
    /// Distance ahead of the place to hold, in m.
    pub distance_m: f32,
    /// Angle beyond the heading to hold, in rad.
    pub yaw_error_rad: f32,
    pushed: Pushed,
    /// The stop under way. Then the speed above is that of the hips.
    pub stop: Option<Stop>,
}

/// The robot's own motion.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Own {
    /// Speed of the axles in m/s.
    pub speed_mps: f32,
    pub yaw_rps: f32,
    pub hips: Motion,
}

impl Reference {
    /// Begins at the robot's own motion.
    pub fn at(speed_mps: f32, yaw_rps: f32) -> Self {
        Self {
            speed_mps,
            yaw_rps,
            ..Self::default()
        }
    }

    /// Moves on by `dt_s` beside a robot with this motion, which stops as planned after a push if it `may_stop`. A wish to drive
    /// waits for the end of a stop that has begun: to break it off would change the lean at once.
    pub fn step(&mut self, wish: Wish, own: &Own, may_stop: bool, dt_s: f32) {
        let drives = wish.speed_mps.abs() > STANDS_MPS;
        if !may_stop || (drives && self.stop.is_none()) {
            self.break_off(own);
        }
        let error_mps = own.speed_mps - self.speed_mps;
        if let Some(stop) = &mut self.stop {
            let mut plan = Motion {
                speed_mps: self.speed_mps,
                accel_mps2: self.accel_mps2,
            };
            let wish_mps = scalar::clamp(wish.speed_mps, -STANDS_MPS, STANDS_MPS);
            let goes_on = stop.step(&mut plan, wish_mps, &own.hips, dt_s);
            self.speed_mps = plan.speed_mps;
            self.accel_mps2 = plan.accel_mps2;
            if !goes_on {
                self.forget_push();
            }
        } else if may_stop
            && !drives
            && let Some(stop) = self.pushed.step(error_mps, wish.speed_mps, &own.hips, dt_s)
        {
            self.stop = Some(stop);
            self.speed_mps = own.hips.speed_mps;
            self.accel_mps2 = own.hips.accel_mps2;
            self.distance_m = 0.0;
        } else {
            self.follow(wish.speed_mps, dt_s);
            self.hold(own.speed_mps - self.speed_mps, dt_s);
        }
        self.turn(wish.yaw_rps, own.yaw_rps, dt_s);
    }

    fn follow(&mut self, wish_mps: f32, dt_s: f32) {
        let behind_mps = wish_mps - self.speed_mps;
        let jerk_mps3 = FOLLOW_RPS * FOLLOW_RPS * behind_mps - 2.0 * FOLLOW_RPS * self.accel_mps2;
        self.accel_mps2 = scalar::clamp(
            self.accel_mps2 + jerk_mps3 * dt_s,
            -MAX_ACCEL_MPS2,
            MAX_ACCEL_MPS2,
        );
        self.speed_mps += self.accel_mps2 * dt_s;
    }

    fn hold(&mut self, error_mps: f32, dt_s: f32) {
        self.distance_m = scalar::clamp(
            self.distance_m + error_mps * dt_s,
            -MAX_DISTANCE_M,
            MAX_DISTANCE_M,
        );
        if error_mps.abs() > LETS_GO_MPS {
            self.distance_m -= self.distance_m * (dt_s / LET_GO_S);
        }
    }

    fn turn(&mut self, wish_rps: f32, yaw_rps: f32, dt_s: f32) {
        let limit_rps = MAX_SIDEWAYS_MPS2 / scalar::max(self.speed_mps.abs(), 0.1);
        let wish_rps = scalar::clamp(wish_rps, -limit_rps, limit_rps);
        let most_rps = MAX_YAW_RPSS * dt_s;
        self.yaw_rps += scalar::clamp(wish_rps - self.yaw_rps, -most_rps, most_rps);
        self.yaw_error_rad = scalar::clamp(
            self.yaw_error_rad + (yaw_rps - self.yaw_rps) * dt_s,
            -MAX_YAW_ERROR_RAD,
            MAX_YAW_ERROR_RAD,
        );
    }

    /// Forgets the place to hold and keeps the speed.
    pub fn let_go(&mut self) {
        self.distance_m = 0.0;
        self.accel_mps2 = 0.0;
        self.forget_push();
    }

    /// The robot has been pushed and catches itself.
    pub fn catches(&self) -> bool {
        self.stop.is_some() || self.pushed.lasts()
    }

    /// Plans no stop, and follows the axles again instead of the hips.
    fn break_off(&mut self, own: &Own) {
        if self.stop.is_some() {
            self.speed_mps = own.speed_mps;
            self.accel_mps2 = scalar::clamp(self.accel_mps2, -MAX_ACCEL_MPS2, MAX_ACCEL_MPS2);
        }
        self.forget_push();
    }

    /// Plans no stop.
    fn forget_push(&mut self) {
        self.pushed = Pushed::default();
        self.stop = None;
    }
}

#[cfg(test)]
mod tests;
