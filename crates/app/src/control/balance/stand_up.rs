//! Standing up: rock, turn upright by the wheels' torque, extend the legs.
//!
//! A robot that lies on an edge has its centre of mass beside its axles, further than little friction lets the wheels
//! drive. Long legs lift it, and when they are folded it falls back from the edge and turns on by itself.

use super::{
    law::{Goal, Law, Torques},
    measured::Measured,
    ramp::Ramp,
    tip::{held, tip},
};
use crate::{
    domain::{BalanceProfile, StandUpPhase, WheelOdomConfig},
    kinematics::Leg,
};

/// Longest time of standing up in s.
const GIVE_UP_S: f32 = 2.6;
/// Time of lifting in s, the length in m that the legs are extended by, and the stiffness and damping for it.
const LIFT_S: f32 = 0.4;
const LIFT_M: f32 = 0.03;
const LIFT_N_PER_M: f32 = 400.0;
const LIFT_NS_PER_M: f32 = 25.0;
/// Push in N with which a leg is folded at once.
const FOLD_N: f32 = -60.0;
/// The robot balances from this lean in rad on, or from a larger one that will be small so soon, in s.
const BALANCED_RAD: f32 = 0.2;
const SOON_S: f32 = 0.1;
const SOON_BALANCED_RAD: f32 = 0.3;
const CATCHABLE_RAD: f32 = 0.5;
/// Largest speed in m/s with which it begins to balance. Wheels that have slipped turn faster.
const BEGIN_MPS: f32 = 0.5;
/// Rates in rad/s and m/s.
const ERECT_RPS: f32 = 3.0;
const EXTEND_MPS: f32 = 0.25;
/// The legs have their length when they are this close to it, in m.
const CLOSE_M: f32 = 0.015;
/// Upright: pitch and lean in rad and their rates in rad/s.
const UPRIGHT_RAD: f32 = 0.2;
const UPRIGHT_RPS: f32 = 1.0;

/// Where standing up has arrived.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StandUp {
    pub phase: StandUpPhase,
    length: Ramp,
    pitch: Ramp,
    /// The legs are held and the wheels turn the robot.
    tips: bool,
    elapsed_s: f32,
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
            tips: true,
            elapsed_s: 0.0,
        }
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
        if self.elapsed_s > GIVE_UP_S {
            return Rising::GaveUp;
        }
        let limits = &profile.limits;
        match self.phase {
            StandUpPhase::None | StandUpPhase::Fold => {
                if self.elapsed_s > LIFT_S {
                    self.phase = StandUpPhase::Erect;
                }
                let push_n = |leg: &Leg| {
                    LIFT_N_PER_M * (limits.fold_length_m + LIFT_M - leg.length_m)
                        - LIFT_NS_PER_M * leg.length_mps
                };
                return Rising::Torques(held(limits, measured, push_n, 0.0));
            }
            StandUpPhase::Erect if self.tips => {
                if can_balance(measured) {
                    self.tips = false;
                    self.length = Ramp::at(measured.length_m());
                    self.pitch = Ramp::at(measured.tilt.pitch_rad);
                    *law = Law::new(profile, measured);
                    law.begin_within(BEGIN_MPS);
                }
                return Rising::Torques(tip(limits, measured, 0.0, 0.0, FOLD_N));
            }
            StandUpPhase::Erect => {
                if measured.mean_lean_rad().abs() < CATCHABLE_RAD {
                    self.length.step(limits.min_length_m, EXTEND_MPS, dt_s);
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
            ..Goal::upright(self.length)
        };
        Rising::Torques(law.step(profile, odometry, measured, &goal, dt_s))
    }
}

fn can_balance(measured: &Measured) -> bool {
    let lean_rad = measured.mean_lean_rad();
    let soon_rad = lean_rad + SOON_S * measured.mean_lean_rps();
    lean_rad.abs() < BALANCED_RAD
        || (lean_rad.abs() < CATCHABLE_RAD && soon_rad.abs() < SOON_BALANCED_RAD)
}

fn is_upright(measured: &Measured) -> bool {
    let tilt = &measured.tilt;
    tilt.pitch_rad.abs() < UPRIGHT_RAD
        && tilt.roll_rad.abs() < UPRIGHT_RAD
        && measured.mean_lean_rad().abs() < UPRIGHT_RAD
        && tilt.pitch_rps.abs() < UPRIGHT_RPS
        && measured.mean_lean_rps().abs() < UPRIGHT_RPS
}
