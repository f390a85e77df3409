//! Decides at 100 Hz what the robot shall do.
//!
//! The mode switch selects the source: the sticks, the PC, or your own logic. It may move while the robot is armed.
//! The new source takes over in the next round, within 10 ms. Without a valid command from it the robot has no
//! torque.

use super::{CustomLogic, LogicDecision, LogicInputs, UserLogic, manual::ManualDrive};
use crate::domain::{DriveMode, LogicBus};

/// Selects the command source and asks it for a command.
///
/// ```
/// use robot_app::domain::{RemoteUpdate, SafetyConfig, SensorsSnapshot, StateEstimate};
/// use robot_app::logic::{LogicInputs, LogicStage, UserLogic};
///
/// let mut remote = RemoteUpdate::default();
/// remote.diagnostics.good_ts_us = 1_000_000;
/// remote.operator.enabled = true;
/// remote.operator.e_stop = false;
/// remote.state.vx = 1.0;
/// let inputs = LogicInputs {
///     config: &SafetyConfig::default(),
///     remote: &remote,
///     sensors: &SensorsSnapshot::default(),
///     estimate: &StateEstimate::default(),
///     armed: true,
///     battery_v: 24.0,
/// };
/// let mut stage = LogicStage::new(UserLogic);
/// let bus = stage.step(&inputs, 1_010_000);
/// assert!(bus.hl_valid && bus.hl_cmd.vx == 1.0);
/// // Half a second without a frame: no command.
/// assert!(!stage.step(&inputs, 1_500_000).hl_valid);
/// ```
#[derive(Clone, Debug, Default)]
pub struct LogicStage<L: CustomLogic = UserLogic> {
    custom: L,
    manual: ManualDrive,
}

impl<L: CustomLogic> LogicStage<L> {
    /// A stage with this custom logic.
    pub fn new(custom: L) -> Self {
        Self {
            custom,
            manual: ManualDrive::default(),
        }
    }

    /// Returns a valid command only while the remote is fresh, enabled, not in failsafe and not e-stopped. This holds
    /// in every mode.
    pub fn step(&mut self, inputs: &LogicInputs<'_>, now_us: u64) -> LogicBus {
        let mode = inputs.remote.operator.mode;
        let allowed = pilot_allows_motion(inputs, now_us);
        if !allowed || mode != DriveMode::Custom {
            self.custom.reset();
        }
        if !allowed || mode != DriveMode::Manual {
            self.manual = ManualDrive::default();
        }
        let decision = if allowed {
            match mode {
                DriveMode::Manual => {
                    let stick_centre = inputs.config.stick_centre;
                    LogicDecision::Drive(self.manual.step(inputs.remote, stick_centre, now_us))
                }
                DriveMode::Pc => LogicDecision::Pc,
                DriveMode::Custom => self.custom.step(inputs, now_us),
            }
        } else {
            LogicDecision::Nothing
        };
        decision.on_bus(now_us)
    }
}

fn pilot_allows_motion(inputs: &LogicInputs<'_>, now_us: u64) -> bool {
    let remote = inputs.remote;
    let link = remote.diagnostics.at(now_us);
    let connected = link.age_us <= inputs.config.remote_timeout_us && !link.failsafe;
    connected && remote.operator.enabled && !remote.operator.e_stop
}

#[cfg(test)]
mod tests;
