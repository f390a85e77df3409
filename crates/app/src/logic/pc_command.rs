//! What the computer on the PC link wants.

use crate::domain::HighLevelCommand;

/// A PC steers, but never arms: its command counts only while the pilot's switches let the robot run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct PcCommand {
    pub command: HighLevelCommand,
    /// When it was received, 0 = never.
    pub ts_us: u64,
}
