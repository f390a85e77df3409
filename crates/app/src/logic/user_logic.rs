//! The place for your own logic, which decides while the mode switch is at custom.
//!
//! Write it in `step`: read `inputs` and return `LogicDecision::Drive` (normalised speed and turn for the controller)
//! or `LogicDecision::Direct` (currents and joint commands that bypass the controller). State goes into the struct;
//! `reset` restores its initial value. The shipped version returns no command, and the robot stands without torque.

use super::{CustomLogic, LogicDecision, LogicInputs};

/// Your own logic.
#[derive(Clone, Copy, Debug, Default)]
pub struct UserLogic;

impl CustomLogic for UserLogic {
    fn step(&mut self, _inputs: &LogicInputs<'_>, _now_us: u64) -> LogicDecision {
        LogicDecision::Nothing
    }

    fn reset(&mut self) {}
}
