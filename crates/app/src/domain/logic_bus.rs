//! The output of the logic stage.

use super::{ChassisCommand, HighLevelCommand};

/// One command for the control tick. `cmd` goes straight to the actuators and has priority over `hl_cmd`, which goes
/// through the controller. With `pc_selected` the tick follows the PC, whose newest command it takes from the link
/// itself. If none of the three is set, every actuator gets zero.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct LogicBus {
    /// Direct actuator command.
    pub cmd: ChassisCommand,
    /// Whether `cmd` is valid.
    pub cmd_valid: bool,
    /// Command for the controller.
    pub hl_cmd: HighLevelCommand,
    /// Whether `hl_cmd` is valid.
    pub hl_valid: bool,
    /// The PC commands.
    pub pc_selected: bool,
    /// Time of the decision in µs since boot, 0 = never.
    pub ts_us: u64,
}
