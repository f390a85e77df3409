//! Standing up: fold the legs, drive the wheels under the body so that it turns upright, extend the legs.

use super::{
    law::{Goal, Ground, Law, Torques},
    measured::Measured,
    ramp::Ramp,
    reference::Wish,
    torques,
    virtual_leg::LegForce,
};
use crate::{
    domain::{BalanceLimits, BalanceProfile, StandUpPhase, WheelOdomConfig},
    kinematics::Leg,
};

/// Longest time of folding, and of standing up in all, in s.
const FOLD_S: f32 = 0.6;
const GIVE_UP_S: f32 = 2.6;
/// Stiffness and damping of a folding leg along and across it, for a leg that carries little.
const FOLD_N_PER_M: f32 = 400.0;
const FOLD_NS_PER_M: f32 = 25.0;
const FOLD_NM_PER_RAD: f32 = 12.0;
const FOLD_NMS_PER_RAD: f32 = 0.6;
/// A folded leg is this close to its pose, in m and rad.
const FOLDED_M: f32 = 0.015;
const FOLDED_RAD: f32 = 0.12;
/// Rates in rad/s and m/s.
const ERECT_RPS: f32 = 3.0;
const EXTEND_MPS: f32 = 0.25;
/// Upright: pitch and lean in rad and their rates in rad/s.
const UPRIGHT_RAD: f32 = 0.2;
const UPRIGHT_RPS: f32 = 1.0;

/// Where standing up has arrived.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StandUp {
    pub phase: StandUpPhase,
    length: Ramp,
    pitch: Ramp,
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
                if is_folded(limits, measured) || self.elapsed_s > FOLD_S {
                    self.phase = StandUpPhase::Erect;
                    self.length = Ramp::at(measured.length_m());
                    self.pitch = Ramp::at(measured.tilt.pitch_rad);
                    *law = Law::new(profile, measured);
                }
                return Rising::Torques(fold(limits, measured));
            }
            StandUpPhase::Erect => {
                self.length.step(limits.min_length_m, EXTEND_MPS, dt_s);
                self.pitch.step(0.0, ERECT_RPS, dt_s);
                if is_upright(measured) {
                    self.phase = StandUpPhase::Extend;
                }
            }
            StandUpPhase::Extend => {
                self.pitch.step(0.0, ERECT_RPS, dt_s);
                self.length.step(length_m, EXTEND_MPS, dt_s);
                if (self.length.value - length_m).abs() < FOLDED_M && is_upright(measured) {
                    return Rising::Stands(self.length.value);
                }
            }
        }
        let goal = Goal {
            wish: Wish::default(),
            length_m: self.length.value,
            length_mps: self.length.rate,
            roll_rad: 0.0,
            pitch_rad: self.pitch.value,
            push_n: None,
            learn: self.phase == StandUpPhase::Extend,
            ground: Ground::Touched,
        };
        Rising::Torques(law.step(profile, odometry, measured, &goal, dt_s))
    }
}

/// Shortens the legs and turns them to the middle of their range. It takes little torque, so the body stays where it
/// lies.
fn fold(limits: &BalanceLimits, measured: &Measured) -> Torques {
    let hips_nm = measured.legs.each_ref().map(|leg: &Leg| {
        let force = LegForce {
            push_n: FOLD_N_PER_M * (limits.min_length_m - leg.length_m)
                - FOLD_NS_PER_M * leg.length_mps,
            lean_nm: FOLD_NM_PER_RAD * leg.angle_rad + FOLD_NMS_PER_RAD * leg.angle_rps,
        };
        torques::within_hips(leg, force, 0.0, limits.hip_nm)
    });
    Torques {
        wheels_nm: [0.0; 2],
        hips_nm,
    }
}

fn is_folded(limits: &BalanceLimits, measured: &Measured) -> bool {
    measured.legs.iter().all(|leg| {
        (leg.length_m - limits.min_length_m).abs() < FOLDED_M && leg.angle_rad.abs() < FOLDED_RAD
    })
}

fn is_upright(measured: &Measured) -> bool {
    let tilt = &measured.tilt;
    tilt.pitch_rad.abs() < UPRIGHT_RAD
        && tilt.roll_rad.abs() < UPRIGHT_RAD
        && measured.mean_lean_rad().abs() < UPRIGHT_RAD
        && tilt.pitch_rps.abs() < UPRIGHT_RPS
        && measured.mean_lean_rps().abs() < UPRIGHT_RPS
}
