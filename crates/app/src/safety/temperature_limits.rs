//! Checks the motors' temperatures.

use super::{SafetyFlags, debounce::DebouncedLimit};
use crate::domain::{MotorFeedback, SafetyConfig};

/// A single report with a wrong byte must not count.
const HOLD_US: u32 = 500_000;
/// The motors must cool by this much before they run again.
const MARGIN_C: f32 = 10.0;

#[derive(Clone, Debug, Default)]
pub(super) struct TemperatureLimits {
    wheels: DebouncedLimit,
    joints: DebouncedLimit,
}

impl TemperatureLimits {
    pub fn check(
        &mut self,
        motor: &MotorFeedback,
        config: &SafetyConfig,
        dt_us: u32,
        flags: &mut SafetyFlags,
    ) {
        let wheels_cool = |margin_c: f32| {
            let limit_c = config.max_wheel_c - margin_c;
            let mut wheels = motor.wheels.iter();
            wheels.all(|wheel| f32::from(wheel.temperature_c) <= limit_c)
        };
        let joints_cool = |margin_c: f32| {
            let limit_c = config.max_joint_c - margin_c;
            let mut joints = motor.joints.iter();
            joints.all(|joint| joint.temperature_c <= limit_c)
        };
        let wheels_hot = self.wheels.step(wheels_cool, MARGIN_C, dt_us, HOLD_US);
        let joints_hot = self.joints.step(joints_cool, MARGIN_C, dt_us, HOLD_US);
        flags.add_if(SafetyFlags::WHEEL_HOT, wheels_hot);
        flags.add_if(SafetyFlags::JOINT_HOT, joints_hot);
    }
}
