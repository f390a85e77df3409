//! The interface of a controller.

use crate::domain::{
    BalanceStatus, ChassisCommand, HighLevelCommand, JointControllerConfig, OperatorState,
    RobotProfile, SensorsSnapshot, StandPermit, StateEstimate, WheelControllerConfig,
    WheelOdomConfig,
};

/// What a controller gets in one tick.
#[derive(Clone, Copy, Debug)]
pub struct ChassisControllerInput<'a> {
    /// Measurements of all sensors and motors.
    pub sensors: &'a SensorsSnapshot,
    /// Estimated attitude and motion.
    pub estimate: &'a StateEstimate,
    /// Geometry of the wheels.
    pub wheel_odom_cfg: &'a WheelOdomConfig,
    /// Gains and limits of the wheel controller.
    pub wheel_ctrl_cfg: &'a WheelControllerConfig,
    /// Gains of the joint controller.
    pub joint_ctrl_cfg: &'a JointControllerConfig,
    /// Figures of the robot.
    pub profile: &'a RobotProfile,
    /// The pilot's switches.
    pub operator_state: &'a OperatorState,
    /// The command to follow. Its components are meant to lie in −1…1, but may not.
    pub hl_cmd: HighLevelCommand,
    /// Whether the robot may stand up or stand. A controller stands only while this and the command say so.
    pub stand: StandPermit,
    /// The wheel commands of this tick are discarded. Controllers restart what integrates wheel errors.
    pub wheels_stopped: bool,
    /// The joint commands of this tick are discarded.
    pub joints_stopped: bool,
}

/// What a controller returns.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ChassisControllerOutput {
    /// The actuator commands.
    pub cmd: ChassisCommand,
    /// Whether `cmd` is valid. If not, every actuator gets zero.
    pub cmd_valid: bool,
    /// State of the balance controller. Any state but `Sit` makes every stop of a part a stop of everything.
    pub balance: BalanceStatus,
}

/// A control algorithm. It is called at 1 kHz while the robot is armed and a valid, fresh high-level command is
/// present. The safety policy limits its output and may cut it to zero.
pub trait ChassisController {
    /// Computes the actuator commands of one tick.
    fn step(&mut self, input: &ChassisControllerInput<'_>) -> ChassisControllerOutput;

    /// Clears integrators and filters. It is called in every tick without [`step`](Self::step), so each drive starts
    /// fresh. If only wheels or only joints are stopped, `step` continues and the input says so.
    fn reset(&mut self);
}
