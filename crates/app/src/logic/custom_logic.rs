//! The interface of your own logic.

use super::{LogicDecision, LogicInputs};

/// Decides at 100 Hz while the mode switch is at custom and the pilot's switches allow motion. The safety policy
/// limits its commands and may cut them to zero.
pub trait CustomLogic {
    /// Returns the command of this round.
    fn step(&mut self, inputs: &LogicInputs<'_>, now_us: u64) -> LogicDecision;

    /// Restores the initial state. It is called in every round without [`step`](Self::step).
    fn reset(&mut self);
}
