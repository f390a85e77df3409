//! The interface of a user's own logic.

use super::{LogicDecision, LogicInputs};

/// Decides at 100 Hz while the mode switch says custom and the pilot's switches let the robot run. Whatever it wants is
/// limited and may be cut to zero by the safety policy.
pub trait CustomLogic {
    fn step(&mut self, inputs: &LogicInputs<'_>, now_us: u64) -> LogicDecision;

    /// Back to the start: called in every round without [`step`](Self::step).
    fn reset(&mut self);
}
