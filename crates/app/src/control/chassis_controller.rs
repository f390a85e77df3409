//! The interface of a controller (ROBOT_CPP 3.4).

use crate::domain::{
    ChassisCommand, HighLevelCommand, JointControllerConfig, OperatorState, SensorsSnapshot,
    StateEstimate, WheelControllerConfig, WheelOdomConfig,
};

/// All a controller may look at in one tick.
#[derive(Clone, Copy, Debug)]
pub struct ChassisControllerInput<'a> {
    pub sensors: &'a SensorsSnapshot,
    pub estimate: &'a StateEstimate,
    pub wheel_odom_cfg: &'a WheelOdomConfig,
    pub wheel_ctrl_cfg: &'a WheelControllerConfig,
    pub joint_ctrl_cfg: &'a JointControllerConfig,
    pub operator_state: &'a OperatorState,
    /// From whoever is in command; not sure to be inside −1 … 1.
    pub hl_cmd: HighLevelCommand,
    /// Wheel commands of this tick go nowhere: what integrates their errors must start again.
    pub wheels_stopped: bool,
    /// The same for joints.
    pub joints_stopped: bool,
}

/// What it wants. Not valid = zero on every actuator.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ChassisControllerOutput {
    pub cmd: ChassisCommand,
    pub cmd_valid: bool,
}

/// A control algorithm, called at 1 kHz while the robot is armed and a high-level command is valid and fresh. Whatever
/// it returns is limited and may be cut to zero by the safety policy.
pub trait ChassisController {
    fn step(&mut self, input: &ChassisControllerInput<'_>) -> ChassisControllerOutput;

    /// Forgets integrators and filters: called in every tick without [`step`](Self::step), so that a controller starts
    /// each drive fresh. If only wheels or only joints are cut off, `step` goes on and the input says so.
    fn reset(&mut self);
}
