//! 100 Hz decision what to do (ROBOT_CPP 2.2.5).
//!
//! The mode switch says who decides: the sticks, the PC, or the user's own logic. It may move while the robot is armed:
//! the new source's command counts from the next round, within 10 ms, whatever the old one wanted, and without a valid
//! one the robot is without torque.

use super::{CustomLogic, LogicBus, LogicDecision, LogicInputs, UserLogic, manual};
use crate::domain::{DriveMode, age_us};

/// Asks whoever is in command while the pilot lets the robot run.
#[derive(Clone, Debug, Default)]
pub struct LogicStage<L: CustomLogic = UserLogic> {
    custom: L,
}

impl<L: CustomLogic> LogicStage<L> {
    pub const fn new(custom: L) -> Self {
        Self { custom }
    }

    /// A valid command only while the remote is fresh, not in failsafe, enabled and not stopped, in every mode.
    pub fn step(&mut self, inputs: &LogicInputs<'_>, now_us: u64) -> LogicBus {
        let mode = inputs.remote.operator.mode;
        let may_run = pilot_lets_run(inputs, now_us);
        if !may_run || mode != DriveMode::Custom {
            self.custom.reset();
        }
        let decision = if may_run {
            match mode {
                DriveMode::Manual => {
                    let stick_centre = inputs.config.stick_centre;
                    LogicDecision::Drive(manual::drive(&inputs.remote.state, stick_centre))
                }
                DriveMode::Pc => from_pc(inputs, now_us),
                DriveMode::Custom => self.custom.step(inputs, now_us),
            }
        } else {
            LogicDecision::Nothing
        };
        LogicBus::from_decision(decision, now_us)
    }
}

fn pilot_lets_run(inputs: &LogicInputs<'_>, now_us: u64) -> bool {
    let remote = inputs.remote;
    let link = remote.diagnostics.at(now_us);
    let connected = link.age_us <= inputs.config.remote_timeout_us && !link.failsafe;
    connected && remote.operator.enabled && !remote.operator.e_stop
}

/// The PC's command has an age like any other.
fn from_pc(inputs: &LogicInputs<'_>, now_us: u64) -> LogicDecision {
    match inputs.pc {
        Some(pc) if age_us(pc.ts_us, now_us) <= inputs.config.command_timeout_us => {
            LogicDecision::Drive(pc.command)
        }
        _ => LogicDecision::Nothing,
    }
}

#[cfg(test)]
mod tests;
