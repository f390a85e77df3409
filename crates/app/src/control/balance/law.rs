//! The balance law: state feedback about a moving reference, and support by the legs.

mod acceleration;
mod flight;

use self::acceleration::Ahead;
use super::{
    braking::counted_mps,
    catch::{Catch, Fall},
    contact::Contact,
    friction,
    gains::{Gains, STATES},
    measured::Measured,
    one_wheel,
    ramp::Ramp,
    reference::{Own, Reference, Wish},
    slip::Slip,
    stop::Motion as Hips,
    support::{GRAVITY_MPS2, Stance, Support},
    torques,
    trim::{Motion, Trim},
    virtual_leg::LegForce,
};
use crate::{
    domain::{BalanceProfile, MassModel, WheelOdomConfig},
    math::scalar,
};

/// A robot that catches itself learns no trim. These are the largest error of speed in m/s, acceleration of the reference in
/// m/s² and rate of lean in rad/s with which it learns.
const LEARN_MPS: f32 = 0.6;
const LEARN_MPS2: f32 = 0.3;
const LEARN_RPS: f32 = 0.3;
/// Largest turn in rad/s with which it learns: a centrifugal force would count as an error of the centre of mass.
const LEARN_YAW_RPS: f32 = 1.0;
/// A robot that catches itself after a push pushes its wheels so little that they seem to be in the air. Only what lasts longer
/// than this, in s, is a flight, and as much time on the ground makes up for it: one that is carried does not count as caught
/// again and again.
const SEEMS_LIFTED_S: f32 = 0.2;
/// Once a pushed robot has come to rest, within this speed in m/s, its hips are loosened until this time in s after the push: their
/// friction would hold the body as askew as it is by then. For longer they would not rest, and the body would sway.
const LOOSE_MPS: f32 = 0.02;
const LOOSE_S: f32 = 1.5;
/// The legs reach as far as their angle will allow after this time in s.
const REACH_AHEAD_S: f32 = 0.05;
/// Stiffness and damping with which the legs keep together on the ground, in N·m/rad and N·m·s/rad.
const SPLIT_NM_PER_RAD: f32 = 6.0;
const SPLIT_NMS_PER_RAD: f32 = 0.3;
/// The same for their lengths while the body may lie on the ground, which says nothing of roll, in N/m and N·s/m.
const LEVEL_N_PER_M: f32 = 600.0;
const LEVEL_NS_PER_M: f32 = 30.0;
/// Torque of each wheel in N·m for each N·m·s with which a robot that pushes off turns forward. It would go on turning in
/// the air.
const TURN_NM_PER_NMS: f32 = 20.0;
/// Push in N that keeps a wheel on the ground while the body would lift it.
const LEAST_PUSH_N: f32 = 2.0;

/// What the robot shall do in this tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Goal {
    pub wish: Wish,
    /// Mean length of the legs in m.
    pub length: Ramp,
    pub roll_rad: f32,
    pub pitch_rad: f32,
    /// Push of each leg in N instead of that which keeps the length.
    pub push_n: Option<f32>,
    /// Learn trim and load.
    pub learn: bool,
    /// Stop as planned after a push. A robot that stands up, lands, or strikes an edge as it drives has other things to do.
    pub stop: bool,
    /// How it is known whether the wheels touch the ground.
    pub ground: Ground,
}

impl Goal {
    /// Standing upright on legs of this length, on the ground, while nothing is learned.
    pub fn upright(length: Ramp) -> Self {
        Self {
            wish: Wish::default(),
            length,
            roll_rad: 0.0,
            pitch_rad: 0.0,
            push_n: None,
            learn: false,
            stop: false,
            ground: Ground::Touched,
        }
    }
}

/// How it is known whether the wheels touch the ground.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ground {
    /// They do.
    Touched,
    /// The forces of the legs tell.
    Felt,
    /// They do not: the robot has just pushed off.
    Left,
}

/// Torques of all motors in N·m, left before right. Wheels are forward positive; joints are front, rear.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Torques {
    pub wheels_nm: [f32; 2],
    pub hips_nm: [[f32; 2]; 2],
}

/// State of the law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Law {
    gains: Gains,
    reference: Reference,
    pub trim: Trim,
    support: Support,
    pub contact: Contact,
    pub slip: Slip,
    catch: Catch,
    wheels_nm: [f32; 2],
    airborne: bool,
    /// Time in s for which no wheel has seemed to touch the ground.
    lifted_s: f32,
    /// Time in s for which the hips may still be loosened.
    loose_s: f32,
}

impl Law {
    /// Begins with the robot's present motion.
    pub fn new(profile: &BalanceProfile, measured: &Measured) -> Self {
        Self {
            gains: Gains::new(&profile.gains, measured.legs.map(|leg| leg.length_m)),
            reference: Reference::at(measured.speed_mps, measured.tilt.yaw_rps),
            trim: Trim::new(motion(measured)),
            support: Support::default(),
            contact: Contact::standing(&profile.mass, measured),
            slip: Slip::default(),
            catch: Catch::default(),
            wheels_nm: [0.0; 2],
            airborne: false,
            lifted_s: 0.0,
            loose_s: 0.0,
        }
    }

    /// Begins with a slower reference where the wheels turn faster than this in m/s.
    pub fn begin_within(&mut self, most_mps: f32) {
        let speed_mps = &mut self.reference.speed_mps;
        *speed_mps = scalar::clamp(*speed_mps, -most_mps, most_mps);
    }

    /// No wheel touches the ground.
    pub fn airborne(&self) -> bool {
        self.airborne
    }

    /// Torques of this tick.
    pub fn step(
        &mut self,
        profile: &BalanceProfile,
        odometry: &WheelOdomConfig,
        measured: &Measured,
        goal: &Goal,
        dt_s: f32,
    ) -> Torques {
        let lengths_m = measured.legs.map(|leg| leg.length_m);
        self.gains.renew(&profile.gains, lengths_m);
        self.contact
            .step(&profile.mass, measured, self.wheels_nm, dt_s);
        let seems_lifted = goal.ground == Ground::Felt && self.contact.airborne();
        if seems_lifted || self.lifted_s > 0.0 {
            let lifted_s = self.lifted_s + if seems_lifted { dt_s } else { -dt_s };
            self.lifted_s = scalar::clamp(lifted_s, 0.0, SEEMS_LIFTED_S);
        }
        let flies = seems_lifted && (!self.reference.catches() || self.lifted_s >= SEEMS_LIFTED_S);
        self.airborne = flies || goal.ground == Ground::Left;
        let (wheels_nm, legs) = if self.airborne {
            self.in_air(profile, odometry, measured, goal)
        } else {
            self.on_ground(profile, odometry, measured, goal, dt_s)
        };
        let limits = &profile.limits;
        let mut wheels_nm = torques::within_wheels(wheels_nm, limits.wheel_nm);
        // A robot that falls freely has no load either, whether it catches itself or not.
        let in_air = self.airborne || seems_lifted;
        let loaded = !in_air && self.contact.lifted() == [false; 2];
        let wheel_kgm2 = profile.mass.wheel_kgm2;
        self.slip
            .step(odometry, wheel_kgm2, measured, self.wheels_nm, loaded, dt_s);
        if !self.airborne {
            wheels_nm = self.slip.within_grip(wheels_nm);
        }
        self.wheels_nm = wheels_nm;
        let [left, right] = &measured.legs;
        let [left_force, right_force] = legs;
        let [left_nm, right_nm] = wheels_nm;
        Torques {
            wheels_nm: if self.airborne {
                wheels_nm
            } else {
                friction::overcome(wheels_nm, measured.gear_rps, limits.wheel_nm)
            },
            hips_nm: [
                torques::within_hips(left, left_force, left_nm, limits.hip_nm),
                torques::within_hips(right, right_force, right_nm, limits.hip_nm),
            ],
        }
    }

    fn on_ground(
        &mut self,
        profile: &BalanceProfile,
        odometry: &WheelOdomConfig,
        measured: &Measured,
        goal: &Goal,
        dt_s: f32,
    ) -> ([f32; 2], [LegForce; 2]) {
        let yaw_rps = measured.tilt.yaw_rps;
        let measured = &Measured {
            speed_mps: self.slip.rolling_mps(measured),
            ..*measured
        };
        let per_mps2 = Ahead::new(profile, odometry, measured);
        let length_m = measured.length_m();
        let trim_rad = self.trim.offset_m / scalar::max(length_m, 0.05);
        let own = Own {
            speed_mps: measured.speed_mps,
            yaw_rps,
            hips: Hips {
                speed_mps: measured.speed_mps + length_m * measured.mean_lean_rps(),
                accel_mps2: (measured.mean_lean_rad() - trim_rad) / per_mps2.lean_rad,
            },
        };
        self.reference.step(goal.wish, &own, goal.stop, dt_s);
        let ahead = per_mps2.times(self.reference.accel_mps2);
        let swing_rps = match &self.reference.stop {
            Some(stop) => per_mps2.lean_rad * stop.jerk_mps3,
            None => 0.0,
        };
        let observed_rad = self
            .trim
            .observe(&motion(measured), per_mps2.lean_rad, length_m, dt_s);
        // The hips go up and down straight.
        let trim_rps = -trim_rad * measured.length_mps() / scalar::max(length_m, 0.05);
        let lean = Ramp {
            value: trim_rad + ahead.lean_rad,
            rate: trim_rps + swing_rps,
        };
        let axles_mps = self.reference.speed_mps - length_m * swing_rps;
        let off_mps = measured.speed_mps - axles_mps;
        let mut error = self.error(measured, off_mps, &lean, goal.pitch_rad);
        let mut length = goal.length;
        if self.reference.catches() || self.catch.helps {
            self.loose_s = LOOSE_S;
            let fall = self.fall(&own, ahead.lean_rad, measured, trim_rad);
            self.catch.step(fall, dt_s);
            let [.., pitch_error, pitch_rate_error] = &mut error;
            *pitch_error -= self.catch.pitch.value;
            *pitch_rate_error -= self.catch.pitch.rate;
            length.value += self.catch.height.value;
            length.rate += self.catch.height.rate;
            // The legs fold no further, and have to push while the robot brakes.
            if length.value < profile.limits.fold_length_m {
                length = Ramp::at(profile.limits.fold_length_m);
            }
        }
        let feedback_nm = self.gains.torques_nm(&error);
        let [left_wheel, right_wheel, left_leg, right_leg] = feedback_nm;
        let [_, speed_error, ..] = error;
        let steady = self.reference.accel_mps2.abs() < LEARN_MPS2
            && measured.mean_lean_rps().abs() < LEARN_RPS
            && yaw_rps.abs() < LEARN_YAW_RPS;
        let catches = self.reference.catches() || self.catch.helps;
        let calm = goal.learn && steady && speed_error.abs() < LEARN_MPS && !catches;
        if calm {
            self.trim.learn(observed_rad * length_m, feedback_nm, dt_s);
        }
        // A body that is pushed harder needs as much more torque against its centre of mass beside the hips.
        let share = self.support.share(&profile.mass, self.contact.push_n());
        let limits = &profile.limits;
        let angle_rad = measured.tilt.pitch_rad - measured.mean_lean_rad();
        let angle_rps = measured.tilt.pitch_rps - measured.mean_lean_rps();
        let angle_rad = angle_rad + REACH_AHEAD_S * angle_rps;
        let stance = Stance {
            length,
            roll_rad: goal.roll_rad,
            sideways_mps2: measured.speed_mps * yaw_rps,
            share,
            off_mps,
            lean_rad: lean.value,
            across_nm: left_leg + right_leg + 2.0 * (self.trim.leg_nm + ahead.leg_nm)
                - self.wheels_nm.iter().sum::<f32>(),
            longest_m: limits.hips_reach_m - limits.hips_reach_m_per_rad * angle_rad.abs(),
        };
        let track_m = odometry.wheel_track_m;
        let [left_n, right_n] =
            self.support
                .step(&profile.mass, track_m, &stance, measured, calm, dt_s);
        // A jump replaces the push of the stronger leg and keeps what levels the body.
        let more_n = match goal.push_n {
            Some(push_n) => push_n - scalar::max(left_n, right_n),
            None => 0.0,
        };
        let turn_nm = match goal.push_n {
            Some(_) => TURN_NM_PER_NMS * turn_nms(&profile.mass, measured, lean.rate),
            None => 0.0,
        };
        let wheel_nm = self.trim.wheel_nm * share + ahead.wheel_nm + turn_nm;
        let leg_nm = self.trim.leg_nm * share + ahead.leg_nm;
        let leg = |push_n: f32, nm: f32| LegForce {
            push_n: scalar::max(push_n + more_n, LEAST_PUSH_N),
            lean_nm: nm + leg_nm,
        };
        let mut legs_nm = [left_leg, right_leg];
        if self.loose_s > 0.0 {
            self.loose_s -= dt_s;
            if self.reference.speed_mps.abs() < LOOSE_MPS {
                legs_nm = legs_nm.map(friction::loosened);
            }
        }
        let [left_nm, right_nm] = legs_nm;
        let split_nm = split_nm(measured);
        let level_n = match goal.ground {
            Ground::Touched => level_n(measured),
            Ground::Felt | Ground::Left => 0.0,
        };
        let both = (
            [left_wheel + wheel_nm, right_wheel + wheel_nm],
            [
                leg(left_n - level_n, left_nm - split_nm),
                leg(right_n + level_n, right_nm + split_nm),
            ],
        );
        match self.contact.lifted() {
            [left, right] if left != right && goal.ground == Ground::Felt => {
                one_wheel::carry(both, left, profile, track_m, measured)
            }
            _ => both,
        }
    }

    /// How a robot falls whose axles would lean by `trim_rad` if it stood still, and by so much more as planned.
    fn fall(&self, own: &Own, planned_rad: f32, measured: &Measured, trim_rad: f32) -> Fall {
        let reference = &self.reference;
        if reference.stop.is_some() {
            return Fall::Stops {
                lean_rad: planned_rad,
            };
        }
        if !reference.catches() {
            return Fall::Over;
        }
        Fall::Falls {
            fast_mps: own.hips.speed_mps - reference.speed_mps,
            lean_rad: measured.mean_lean_rad() - trim_rad,
            lean_rps: measured.mean_lean_rps(),
        }
    }

    fn error(
        &self,
        measured: &Measured,
        off_mps: f32,
        lean: &Ramp,
        pitch_rad: f32,
    ) -> [f32; STATES] {
        let reference = &self.reference;
        let [left_rad, right_rad] = measured.lean_rad;
        let [left_rps, right_rps] = measured.lean_rps;
        let tilt = &measured.tilt;
        // On a robot that turns, the centrifugal force adds to gravity: it falls faster.
        let swing = tilt.yaw_rps * tilt.yaw_rps * measured.length_m() / GRAVITY_MPS2;
        let (growth, lean_rate) = (1.0 + swing, 1.0 + 0.5 * swing);
        [
            reference.distance_m,
            counted_mps(
                off_mps,
                measured.mean_lean_rad() - lean.value,
                measured.mean_lean_rps(),
                self.slip.lately_mps,
            ),
            reference.yaw_error_rad,
            tilt.yaw_rps - reference.yaw_rps,
            growth * (left_rad - lean.value),
            lean_rate * (left_rps - lean.rate),
            growth * (right_rad - lean.value),
            lean_rate * (right_rps - lean.rate),
            tilt.pitch_rad - pitch_rad,
            tilt.pitch_rps,
        ]
    }
}

/// Torque that brings the left leg back to the right one.
fn split_nm(measured: &Measured) -> f32 {
    let ([left_rad, right_rad], [left_rps, right_rps]) = (measured.lean_rad, measured.lean_rps);
    SPLIT_NM_PER_RAD * (left_rad - right_rad) + SPLIT_NMS_PER_RAD * (left_rps - right_rps)
}

/// Push that the right leg gives more and the left one less, so that they are equally long.
fn level_n(measured: &Measured) -> f32 {
    let [left, right] = &measured.legs;
    LEVEL_N_PER_M * (left.length_m - right.length_m)
        + LEVEL_NS_PER_M * (left.length_mps - right.length_mps)
}

/// Angular momentum in N·m·s of a robot whose legs should lean at this rate in rad/s, forward positive.
fn turn_nms(mass: &MassModel, measured: &Measured, lean_rps: f32) -> f32 {
    let length_m = measured.length_m();
    let legs_kgm2 = 2.0 * mass.axle_kg * length_m * length_m;
    mass.pitch_kgm2 * measured.tilt.pitch_rps + legs_kgm2 * (measured.mean_lean_rps() - lean_rps)
}

fn motion(measured: &Measured) -> Motion {
    Motion {
        lean_rad: measured.mean_lean_rad(),
        lean_rps: measured.mean_lean_rps(),
        speed_mps: measured.speed_mps,
    }
}

#[cfg(test)]
mod tests;
