//! Whether the wheels touch the ground, from the legs' pushes and the body's acceleration.

use super::{measured::Measured, support::GRAVITY_MPS2, virtual_leg};
use crate::{domain::MassModel, math::scalar};

/// Time constant in s of the contact force.
const FORCE_TIME_S: f32 = 0.006;
/// The same for the whole robot's force, and the shares of its weight below which it falls freely, and above which no more.
const TOTAL_TIME_S: f32 = 0.008;
const FREE_FALL: f32 = 0.2;
const CAUGHT: f32 = 0.4;
/// Time constant in s of the pitch's acceleration.
const PITCH_TIME_S: f32 = 0.005;
/// Shares of a wheel's standing load below which it is in the air, and above which it is on the ground.
const LIFTED: f32 = 0.15;
const LOADED: f32 = 0.4;
/// Times in s for which that must last.
const LIFTED_S: f32 = 0.008;
const LOADED_S: f32 = 0.003;

/// Contact of one wheel.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WheelContact {
    /// Force of the wheel on the ground in N.
    pub force_n: f32,
    /// Push of the leg in N.
    push_n: f32,
    /// The wheel is in the air.
    lifted: bool,
    length_mps: f32,
    /// Time in s for which the force has contradicted `lifted`.
    contrary_s: f32,
}

/// Contact of both wheels, left and right.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Contact {
    pub wheels: [WheelContact; 2],
    /// The whole robot's force on the ground in N, from accelerations alone.
    total_n: f32,
    /// The whole falls freely.
    falls: bool,
    /// Pitch rate in rad/s behind a low-pass filter.
    pitch_rps: f32,
}

impl Contact {
    /// Begins with both wheels on the ground and half of the load on each.
    pub fn standing(mass: &MassModel, measured: &Measured) -> Self {
        Self {
            wheels: measured.legs.map(|leg| WheelContact {
                force_n: 0.5 * mass.total_kg * GRAVITY_MPS2,
                push_n: 0.5 * mass.carried_kg * GRAVITY_MPS2,
                length_mps: leg.length_mps,
                ..WheelContact::default()
            }),
            total_n: mass.total_kg * GRAVITY_MPS2,
            falls: false,
            pitch_rps: measured.tilt.pitch_rps,
        }
    }

    /// `wheel_nm` is the torque that the wheels were given.
    pub fn step(&mut self, mass: &MassModel, measured: &Measured, wheel_nm: [f32; 2], dt_s: f32) {
        let standing_n = 0.5 * mass.total_kg * GRAVITY_MPS2;
        let legs = measured.legs.iter().zip(&measured.hip_nm);
        let motions = measured.lean_rad.iter().zip(wheel_nm);
        let up_mps2 = self.carried_up_mps2(mass, measured, dt_s);
        let mut total_n = mass.carried_kg * up_mps2;
        for ((wheel, (leg, hip_nm)), (lean_rad, wheel_nm)) in
            self.wheels.iter_mut().zip(legs).zip(motions)
        {
            let [front_nm, rear_nm] = *hip_nm;
            let [front_share, rear_share] = virtual_leg::reaction_nm(leg, wheel_nm);
            let hips_nm = [front_nm - front_share, rear_nm - rear_share];
            let push_n = virtual_leg::force_of(leg, hips_nm).push_n;
            let (_, cos) = scalar::sin_cos_small(scalar::clamp(*lean_rad, -1.0, 1.0));
            let accel_mps2 = (leg.length_mps - wheel.length_mps) / dt_s;
            wheel.length_mps = leg.length_mps;
            // The hips' rotors take their share of the torque.
            let [front, rear] = leg.length_per_rad;
            let rotor_kg = mass.hip_kgm2 / scalar::max(front * front + rear * rear, 1e-3);
            let push_n = push_n - rotor_kg * accel_mps2;
            let axle_mps2 = up_mps2 - accel_mps2 * cos;
            let force_n = push_n * cos + mass.axle_kg * axle_mps2;
            wheel.push_n += (push_n - wheel.push_n) * (dt_s / FORCE_TIME_S);
            wheel.force_n += (force_n - wheel.force_n) * (dt_s / FORCE_TIME_S);
            wheel.decide(standing_n, dt_s);
            total_n += mass.axle_kg * axle_mps2;
        }
        self.total_n += (total_n - self.total_n) * (dt_s / TOTAL_TIME_S);
        let most = if self.falls { CAUGHT } else { FREE_FALL };
        self.falls = self.total_n < most * mass.total_kg * GRAVITY_MPS2;
    }

    /// Specific force in m/s² along the vertical where the centre of what the legs carry is. A body that is struck pitches so hard
    /// that the IMU beside the centre feels a free fall.
    fn carried_up_mps2(&mut self, mass: &MassModel, measured: &Measured, dt_s: f32) -> f32 {
        let pitch_rps = measured.tilt.pitch_rps;
        let pitch_rpss = (pitch_rps - self.pitch_rps) / PITCH_TIME_S;
        self.pitch_rps += pitch_rpss * dt_s;
        measured.up_mps2 + mass.imu_ahead_m * pitch_rpss + mass.imu_over_m * pitch_rps * pitch_rps
    }

    /// Push of both legs in N.
    pub fn push_n(&self) -> f32 {
        self.wheels.iter().map(|wheel| wheel.push_n).sum()
    }

    /// Whether each wheel is in the air by the push of its leg.
    pub fn lifted(&self) -> [bool; 2] {
        self.wheels.each_ref().map(|wheel| wheel.lifted)
    }

    /// No wheel touches the ground: the legs push nothing, or the robot falls freely however they push.
    pub fn airborne(&self) -> bool {
        self.wheels.iter().all(|wheel| wheel.lifted) || self.falls
    }
}

impl WheelContact {
    fn decide(&mut self, standing_n: f32, dt_s: f32) {
        let (contrary, needed_s) = if self.lifted {
            (self.force_n > LOADED * standing_n, LOADED_S)
        } else {
            (self.force_n < LIFTED * standing_n, LIFTED_S)
        };
        self.contrary_s = if contrary {
            self.contrary_s + dt_s
        } else {
            0.0
        };
        if self.contrary_s > needed_s {
            self.lifted = !self.lifted;
            self.contrary_s = 0.0;
        }
    }
}

#[cfg(test)]
mod tests;
