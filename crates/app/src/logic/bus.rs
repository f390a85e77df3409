//! The output of the logic stage (seed section 3.3).

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
