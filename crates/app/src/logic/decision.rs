//! The decision of one command source.

use crate::domain::{ChassisCommand, HighLevelCommand, LogicBus};

/// The command of one source. Every command still needs the torque permit of the control tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum LogicDecision {
    /// No valid command: every actuator gets zero.
    #[default]
    Nothing,
    /// A command for the controller.
    Drive(HighLevelCommand),
    /// A command for the actuators that bypasses the controller.
    Direct(ChassisCommand),
    /// The PC commands. The control tick follows it only while the mode switch is at PC.
    Pc,
}

impl LogicDecision {
    /// Fills in one of the commands of the bus and leaves the others zero.
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
            Self::Pc => LogicBus {
                pc_selected: true,
                ..bus
            },
        }
    }
}
