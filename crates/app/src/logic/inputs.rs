//! The inputs of a decision.

use crate::domain::{RemoteUpdate, SafetyConfig, SensorsSnapshot, StateEstimate};

/// The newest value of each input. What the control tick gives is at most 10 ms old.
#[derive(Clone, Copy, Debug)]
pub struct LogicInputs<'a> {
    /// Limits of ages and sticks.
    pub config: &'a SafetyConfig,
    /// Sticks, switches and link quality.
    pub remote: &'a RemoteUpdate,
    /// IMU, magnetometer and motors.
    pub sensors: &'a SensorsSnapshot,
    /// Attitude and motion.
    pub estimate: &'a StateEstimate,
    /// Whether the robot is armed, so that commands reach the motors as far as the safety policy allows.
    pub armed: bool,
    /// Battery voltage, 0 while it is not measured.
    pub battery_v: f32,
}
