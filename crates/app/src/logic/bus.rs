//! The output of the logic stage (ROBOT_CPP 3.3).

use super::LogicDecision;
use crate::domain::{ChassisCommand, HighLevelCommand};

/// `cmd` goes straight to the actuators and wins over `hl_cmd`, which goes through the controller. Neither valid: zero.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct LogicBus {
    pub cmd: ChassisCommand,
    pub cmd_valid: bool,
    pub hl_cmd: HighLevelCommand,
    pub hl_valid: bool,
    /// When it was decided, 0 = never.
    pub ts_us: u64,
}

impl LogicBus {
    /// What is not valid is zero.
    pub(super) fn from_decision(decision: LogicDecision, ts_us: u64) -> Self {
        let bus = Self {
            ts_us,
            ..Self::default()
        };
        match decision {
            LogicDecision::Nothing => bus,
            LogicDecision::Drive(hl_cmd) => Self {
                hl_cmd,
                hl_valid: true,
                ..bus
            },
            LogicDecision::Direct(cmd) => Self {
                cmd,
                cmd_valid: true,
                ..bus
            },
        }
    }
}
