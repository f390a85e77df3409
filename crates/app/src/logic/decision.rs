//! The decision of one command source.

use crate::domain::{ChassisCommand, HighLevelCommand, LogicBus};

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

impl LogicDecision {
    /// Fills in one of the two commands of the bus and leaves the other one zero.
    pub(super) fn on_bus(self, ts_us: u64) -> LogicBus {
        let bus = LogicBus {
            ts_us,
            ..LogicBus::default()
        };
        match self {
            Self::Nothing => bus,
            Self::Drive(hl_cmd) => LogicBus {
                hl_cmd,
                hl_valid: true,
                ..bus
            },
            Self::Direct(cmd) => LogicBus {
                cmd,
                cmd_valid: true,
                ..bus
            },
        }
    }
}
