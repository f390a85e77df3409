//! What one source of commands wants.

use crate::domain::{ChassisCommand, HighLevelCommand};

/// One of three; the last two still need the permit of the control tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum LogicDecision {
    /// No valid command: zero on every actuator.
    #[default]
    Nothing,
    /// Through the controller.
    Drive(HighLevelCommand),
    /// Straight to the actuators, past the controller.
    Direct(ChassisCommand),
}
