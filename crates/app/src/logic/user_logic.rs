//! The place for your own logic: what the robot does while the mode switch says custom.
//!
//! Write it in `step`: read `inputs`, return `LogicDecision::Drive` (normalised speed and turn, goes through the
//! controller) or `LogicDecision::Direct` (currents and joint commands, past the controller). State goes into the
//! struct, and `reset` brings it back to the start. As shipped it wants nothing, and the robot stands without torque.

use super::{CustomLogic, LogicDecision, LogicInputs};

#[derive(Clone, Copy, Debug, Default)]
pub struct UserLogic;

impl CustomLogic for UserLogic {
    fn step(&mut self, _inputs: &LogicInputs<'_>, _now_us: u64) -> LogicDecision {
        LogicDecision::Nothing
    }

    fn reset(&mut self) {}
}
