//! Speed and position from the wheels.

use crate::{
    domain::{MotorFeedback, WheelOdomConfig},
    math::{Quaternion, Vector3, scalar, vector},
};

/// Feedback older than this says nothing about the speed now.
const MAX_AGE_US: u32 = 50_000;

#[derive(Clone, Debug)]
pub(super) struct WheelOdometry {
    signs: [f32; 2],
    mps_per_rpm: f32,
    velocity_mps: Vector3,
    position_m: Vector3,
}

impl WheelOdometry {
    pub fn new(config: &WheelOdomConfig) -> Self {
        Self {
            signs: config.rpm_signs(),
            mps_per_rpm: config.mps_per_rpm(),
            velocity_mps: [0.0; 3],
            position_m: [0.0; 3],
        }
    }

    /// Other wheels from now on; the way so far stays.
    pub fn set_config(&mut self, config: &WheelOdomConfig) {
        self.signs = config.rpm_signs();
        self.mps_per_rpm = config.mps_per_rpm();
    }

    /// Rolls without slip along the body's x axis laid flat. Silent wheels count as standing.
    pub fn step(&mut self, motor: &MotorFeedback, orientation: Quaternion, dt_s: f32) {
        let forward_mps = self.forward_mps(motor);
        let [x, y, _] = orientation.rotate([1.0, 0.0, 0.0]);
        // Zero when the robot stands on its nose: then it rolls nowhere.
        let inverse = scalar::inverse_sqrt(x * x + y * y);
        let flat = [x * inverse, y * inverse, 0.0];
        self.velocity_mps = vector::scale(flat, forward_mps);
        self.position_m = vector::add(self.position_m, vector::scale(self.velocity_mps, dt_s));
    }

    fn forward_mps(&self, motor: &MotorFeedback) -> f32 {
        let mut sum_rpm = 0.0;
        for (wheel, sign) in motor.wheels.iter().zip(self.signs) {
            if wheel.age_us > MAX_AGE_US {
                return 0.0;
            }
            sum_rpm += sign * f32::from(wheel.rpm);
        }
        sum_rpm / 2.0 * self.mps_per_rpm
    }

    pub const fn velocity_mps(&self) -> Vector3 {
        self.velocity_mps
    }

    pub const fn position_m(&self) -> Vector3 {
        self.position_m
    }
}
