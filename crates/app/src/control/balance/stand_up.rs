//! Standing up: off the edge, upright by the wheels' torque, onto longer legs.
//!
//! A robot that lies on an edge has its centre of mass beside its axles, further than little friction lets the wheels
//! drive. It leaves the edge with a swing towards its wheels: it rocks, or its knees push the edge off.

use super::{
    knees,
    law::{Goal, Ground, Law, Torques},
    measured::Measured,
    ramp::Ramp,
    tip::{held, tip, wheel_nm},
};
use crate::{
    domain::{BalanceProfile, StandUpPhase, WheelOdomConfig},
    kinematics::Leg,
};

/// Longest time of standing up in s.
const GIVE_UP_S: f32 = 2.6;
/// A robot that does not come up lies on its edge again after this time in s, and tries the other way.
const ATTEMPT_S: f32 = 0.7;
/// Time of lifting in s, the length in m that the legs are extended by, and the stiffness and damping for it.
const LIFT_S: f32 = 0.31;
const LIFT_M: f32 = 0.05;
const LIFT_N_PER_M: f32 = 400.0;
const LIFT_NS_PER_M: f32 = 25.0;
/// Longest time in s of pushing with the knees, and the pitch in rad at which the edge is off the ground.
const PUSH_S: f32 = 0.23;
const PUSHED_RAD: f32 = 0.55;
/// Share of the wheels' torque meanwhile.
const PUSH_SHARE: f32 = 0.5;
/// From this pitch in rad the robot lies on its face, with its wheels in the air.
const FACE_RAD: f32 = 1.1;
/// Roll and pitch in rad beyond which neither wheels nor knees can push the robot upright: it lies on a side or its top.
const MAX_ROLL_RAD: f32 = 0.8;
const MAX_PITCH_RAD: f32 = 2.2;
/// Push in N with which a leg is folded at once.
const FOLD_N: f32 = -60.0;
/// The robot balances from this lean in rad on, or from a larger one that will be small so soon, in s. A centre of mass 3 cm
/// ahead of where its file says leans by 0.3 rad more.
const BALANCED_RAD: f32 = 0.2;
const SOON_S: f32 = 0.1;
const SOON_BALANCED_RAD: f32 = 0.15;
const CATCHABLE_RAD: f32 = 0.5;
/// Beyond this lean in rad it has missed its balance and tries again from the edge on which it falls.
const MISSED_RAD: f32 = 0.8;
/// Largest speed in m/s with which it begins to balance. Wheels that have slipped turn faster.
const BEGIN_MPS: f32 = 1.4;
/// Rates in rad/s and m/s.
const ERECT_RPS: f32 = 3.0;
const EXTEND_MPS: f32 = 0.25;
/// The same for a robot that has just come up: it still hops, and longer legs soften that.
const UNFOLD_MPS: f32 = 0.8;
/// The legs have their length when they are this close to it, in m.
const CLOSE_M: f32 = 0.015;
/// Upright: pitch and roll in rad, and rates in rad/s.
const UPRIGHT_RAD: f32 = 0.2;
const UPRIGHT_RPS: f32 = 1.0;
/// Lean in rad of a robot that balances upright on short legs while its centre of mass is far from where its file says.
const UPRIGHT_LEAN_RAD: f32 = 0.5;

/// Where standing up has arrived.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StandUp {
    pub phase: StandUpPhase,
    length: Ramp,
    pitch: Ramp,
    /// The robot pushes with its knees in this attempt.
    pushes: bool,
    /// The legs are held and the wheels turn the robot.
    tips: bool,
    attempt_s: f32,
    elapsed_s: f32,
    /// Speed in m/s by which the estimate was behind wheels without torque.
    behind_mps: f32,
}

/// What comes of a tick of standing up.
pub enum Rising {
    Torques(Torques),
    /// The robot stands on legs of this length in m.
    Stands(f32),
    GaveUp,
}

impl StandUp {
    pub fn new(measured: &Measured) -> Self {
        Self {
            phase: StandUpPhase::Fold,
            length: Ramp::at(measured.length_m()),
            pitch: Ramp::at(measured.tilt.pitch_rad),
            pushes: lies_on_face(measured),
            tips: true,
            attempt_s: 0.0,
            elapsed_s: 0.0,
            behind_mps: 0.0,
        }
    }

    /// Whether the robot can stand up from how it lies.
    pub fn is_possible(measured: &Measured) -> bool {
        let tilt = &measured.tilt;
        tilt.roll_rad.abs() < MAX_ROLL_RAD && tilt.pitch_rad.abs() < MAX_PITCH_RAD
    }

    pub fn step(
        &mut self,
        law: &mut Law,
        profile: &BalanceProfile,
        odometry: &WheelOdomConfig,
        measured: &Measured,
        length_m: f32,
        dt_s: f32,
    ) -> Rising {
        self.elapsed_s += dt_s;
        self.attempt_s += dt_s;
        if self.elapsed_s > GIVE_UP_S || !Self::is_possible(measured) {
            return Rising::GaveUp;
        }
        let limits = &profile.limits;
        match self.phase {
            StandUpPhase::None | StandUpPhase::Fold => {
                return Rising::Torques(self.leave_edge(profile, measured));
            }
            StandUpPhase::Erect if self.tips => {
                if can_balance(measured) {
                    self.tips = false;
                    self.length = Ramp::at(measured.length_m());
                    self.pitch = Ramp::at(measured.tilt.pitch_rad);
                    *law = Law::new(profile, measured);
                    law.begin_within(BEGIN_MPS);
                    law.slip.begin_behind(self.behind_mps);
                } else if self.attempt_s > ATTEMPT_S {
                    self.retry(!self.pushes || lies_on_face(measured));
                }
                return Rising::Torques(tip(limits, measured, FOLD_N));
            }
            StandUpPhase::Erect if measured.mean_lean_rad().abs() > MISSED_RAD => {
                self.retry(lies_on_face(measured));
                return Rising::Torques(tip(limits, measured, FOLD_N));
            }
            StandUpPhase::Erect => {
                if measured.mean_lean_rad().abs() < CATCHABLE_RAD {
                    self.length.step(limits.min_length_m, UNFOLD_MPS, dt_s);
                }
                self.pitch.step(0.0, ERECT_RPS, dt_s);
                if is_upright(measured) {
                    self.phase = StandUpPhase::Extend;
                }
            }
            StandUpPhase::Extend => {
                self.pitch.step(0.0, ERECT_RPS, dt_s);
                self.length.step(length_m, EXTEND_MPS, dt_s);
                if (self.length.value - length_m).abs() < CLOSE_M && is_upright(measured) {
                    return Rising::Stands(self.length.value);
                }
            }
        }
        let goal = Goal {
            pitch_rad: self.pitch.value,
            learn: self.phase == StandUpPhase::Extend,
            ground: Ground::Felt,
            ..Goal::upright(self.length)
        };
        Rising::Torques(law.step(profile, odometry, measured, &goal, dt_s))
    }

    /// Begins again from an edge.
    fn retry(&mut self, pushes: bool) {
        self.phase = StandUpPhase::Fold;
        self.pushes = pushes;
        self.tips = true;
        self.attempt_s = 0.0;
    }

    /// Lifts the robot about its edge, from where it falls back, or pushes the edge off with the knees.
    fn leave_edge(&mut self, profile: &BalanceProfile, measured: &Measured) -> Torques {
        let limits = &profile.limits;
        if self.pushes {
            if measured.tilt.pitch_rad.abs() < PUSHED_RAD
                || knees::are_down(measured)
                || self.attempt_s > PUSH_S
            {
                self.phase = StandUpPhase::Erect;
            }
            return knees::push(limits, measured, PUSH_SHARE * wheel_nm(measured));
        }
        self.behind_mps = measured.speed_mps - measured.ground_mps;
        if self.attempt_s > LIFT_S {
            self.phase = StandUpPhase::Erect;
        }
        let push_n = |leg: &Leg| {
            LIFT_N_PER_M * (limits.fold_length_m + LIFT_M - leg.length_m)
                - LIFT_NS_PER_M * leg.length_mps
        };
        held(limits, measured, push_n, 0.0)
    }
}

fn lies_on_face(measured: &Measured) -> bool {
    measured.tilt.pitch_rad.abs() > FACE_RAD
}

fn can_balance(measured: &Measured) -> bool {
    let lean_rad = measured.mean_lean_rad();
    // Its legs are held, but their joints tell a rate of their own when they strike their stops.
    let soon_rad = lean_rad + SOON_S * measured.tilt.pitch_rps;
    lean_rad.abs() < BALANCED_RAD
        || (lean_rad.abs() < CATCHABLE_RAD && soon_rad.abs() < SOON_BALANCED_RAD)
}

fn is_upright(measured: &Measured) -> bool {
    let tilt = &measured.tilt;
    tilt.pitch_rad.abs() < UPRIGHT_RAD
        && tilt.roll_rad.abs() < UPRIGHT_RAD
        && measured.mean_lean_rad().abs() < UPRIGHT_LEAN_RAD
        && tilt.pitch_rps.abs() < UPRIGHT_RPS
        && measured.mean_lean_rps().abs() < UPRIGHT_RPS
}

#[cfg(test)]
mod tests;
