//! Sitting down: fold the legs, let the body sink onto an edge while the wheels brake it, let go.
//!
//! The body sinks away from its centre of mass: over the other edge it would roll on. The wheels brake it by driving below it,
//! so they first roll the other way: a body that still moves on as it touches the ground tips over its edge.

use super::{
    law::{Goal, Law, Torques},
    measured::Measured,
    ramp::Ramp,
    reference::Wish,
    tip::{held, lean_nm},
};
use crate::{
    domain::{BalanceProfile, WheelOdomConfig},
    kinematics::Leg,
};

/// Rates in m/s and rad/s.
const LOWER_MPS: f32 = 0.2;
const SINK_RPS: f32 = 2.0;
/// Speed in m/s at which the robot rolls away from the edge onto which it will sink.
const ROLL_MPS: f32 = 0.6;
/// The legs are folded when they are this close to their shortest length, in m.
const CLOSE_M: f32 = 0.005;
/// Push in N of a leg that the body's weight folds onto its stops, and its damping in N·s/m.
const SINK_N: f32 = 5.0;
const SINK_NS_PER_M: f32 = 100.0;
/// Damping of the lean in N·m·s/rad for each wheel, more than for tipping.
const LEAN_NMS_PER_RAD: f32 = 2.0;
/// From this pitch in rad on the body falls by itself: a few degrees are left, and safety takes more for a fall.
const LET_GO_RAD: f32 = 0.62;
/// A body that has not fallen when the reference of its lean has come this far, in rad, lies on the ground.
const MOST_RAD: f32 = 0.8;
/// Longest time of it all in s.
const GIVE_UP_S: f32 = 3.0;

/// Where sitting down has arrived.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SitDown {
    length: Ramp,
    sinking: Option<Sinking>,
    elapsed_s: f32,
}

/// The body sinks.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Sinking {
    /// Reference of the lean in rad.
    lean_rad: f32,
    /// Its rate in rad/s, positive onto the front edge.
    rps: f32,
}

impl SitDown {
    pub const fn new(length: Ramp) -> Self {
        Self {
            length,
            sinking: None,
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
        if let Some(Sinking { lean_rad, rps }) = &mut self.sinking {
            *lean_rad += *rps * dt_s;
            let sinks = lean_rad.abs() < MOST_RAD && measured.tilt.pitch_rad.abs() < LET_GO_RAD;
            let wheel_nm = lean_nm(
                measured.mean_lean_rad() - *lean_rad,
                measured.mean_lean_rps() - *rps,
                LEAN_NMS_PER_RAD,
            );
            let push_n = |leg: &Leg| SINK_N - SINK_NS_PER_M * leg.length_mps;
            return sinks.then(|| held(limits, measured, push_n, wheel_nm));
        }
        // A robot that leans back to balance has its centre of mass ahead.
        let sign = if law.trim.offset_m < 0.0 { -1.0 } else { 1.0 };
        self.length.step(limits.fold_length_m, LOWER_MPS, dt_s);
        if self.length.value - limits.fold_length_m < CLOSE_M {
            self.sinking = Some(Sinking {
                lean_rad: measured.mean_lean_rad(),
                rps: sign * SINK_RPS,
            });
        }
        let goal = Goal {
            wish: Wish {
                speed_mps: -sign * ROLL_MPS,
                yaw_rps: 0.0,
            },
            ..Goal::upright(self.length)
        };
        Some(law.step(profile, odometry, measured, &goal, dt_s))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::domain::robots::FIVEBAR;

    /// The wheels of a robot drive away from the edge onto which it sinks, as its lean stays behind: 8 N·m/rad for the 0.04 rad of 20 ms
    /// at 2 rad/s.
    #[test]
    fn the_wheels_let_the_body_sink_to_the_side_to_which_it_stands_leaning() {
        let profile = &FIVEBAR.balance;
        let fold_m = profile.limits.fold_length_m;
        for sign in [1.0, -1.0] {
            let measured = Measured {
                // The trim decides, whatever the lean of the moment.
                lean_rad: [-sign * 0.1; 2],
                lean_rps: [sign * SINK_RPS; 2],
                ..Measured::at_rest()
            };
            let mut law = Law::new(profile, &measured);
            law.trim.offset_m = sign * 0.01;
            let mut sit_down = SitDown::new(Ramp::at(fold_m));
            let mut step =
                || sit_down.step(&mut law, profile, &FIVEBAR.wheel_odom, &measured, 0.001);
            for _ in 0..20 {
                assert!(step().is_some());
            }
            let [left_nm, right_nm] = step().expect("it sinks").wheels_nm;
            assert_eq!(left_nm, right_nm);
            assert!((sign * left_nm + 0.32).abs() < 0.001, "{left_nm}");
        }
    }

    /// To roll away from the edge it first has to lean away from it, and the wheels run towards it for that.
    #[test]
    fn on_long_legs_it_begins_to_roll_away_from_the_edge() {
        let profile = &FIVEBAR.balance;
        let long_m = profile.limits.max_length_m;
        for sign in [1.0, -1.0] {
            let measured = Measured::at_rest();
            let mut law = Law::new(profile, &measured);
            law.trim.offset_m = sign * 1e-6;
            let mut sit_down = SitDown::new(Ramp::at(long_m));
            let mut step =
                || sit_down.step(&mut law, profile, &FIVEBAR.wheel_odom, &measured, 0.001);
            for _ in 0..50 {
                assert!(step().is_some());
            }
            let wheels_nm = step().expect("its legs fold").wheels_nm;
            assert!(wheels_nm.iter().all(|nm| sign * nm > 0.05), "{wheels_nm:?}");
        }
    }
}
