//! The command of the computer on the PC link.

use crate::domain::HighLevelCommand;

/// A command from a PC. A PC steers but never arms: the command is used only while the pilot's switches allow motion.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct PcCommand {
    /// Normalised drive and turn.
    pub command: HighLevelCommand,
    /// Time of reception in µs since boot, 0 = never.
    pub ts_us: u64,
}
