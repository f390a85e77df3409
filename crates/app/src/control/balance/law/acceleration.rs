//! What a robot takes to accelerate.

use crate::{
    control::balance::{measured::Measured, support::GRAVITY_MPS2},
    domain::{BalanceProfile, WheelOdomConfig},
    math::scalar,
};

/// What an acceleration takes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ahead {
    pub lean_rad: f32,
    pub wheel_nm: f32,
    pub leg_nm: f32,
}

impl Ahead {
    /// What 1 m/s² takes.
    pub fn new(profile: &BalanceProfile, odometry: &WheelOdomConfig, measured: &Measured) -> Self {
        let mass = &profile.mass;
        let radius_m = scalar::max(odometry.wheel_radius_m, 0.01);
        let length_m = measured.length_m();
        let rolling_kg = 2.0 * mass.wheel_kgm2 / (radius_m * radius_m);
        let body = mass.carried_kg * mass.carried_up_m;
        // The rotors' part of the torque does not reach the legs.
        let legs = mass.carried_kg * length_m + mass.total_kg * radius_m + body;
        Self {
            lean_rad: legs / (mass.carried_kg * GRAVITY_MPS2 * length_m),
            wheel_nm: 0.5 * (mass.total_kg + rolling_kg) * radius_m,
            leg_nm: -0.5 * body,
        }
    }

    pub fn times(self, accel_mps2: f32) -> Self {
        Self {
            lean_rad: self.lean_rad * accel_mps2,
            wheel_nm: self.wheel_nm * accel_mps2,
            leg_nm: self.leg_nm * accel_mps2,
        }
    }
}
