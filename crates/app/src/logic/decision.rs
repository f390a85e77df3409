//! The decision of one command source.

use crate::domain::{ChassisCommand, HighLevelCommand};

/// The command of one source. Drive and direct commands still need the torque permit of the control tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum LogicDecision {
    /// No valid command: every actuator gets zero.
    #[default]
    Nothing,
    /// A command for the controller.
    Drive(HighLevelCommand),
    /// A command for the actuators that bypasses the controller.
    Direct(ChassisCommand),
}
