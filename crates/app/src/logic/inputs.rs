//! All that a decision may look at.

use super::PcCommand;
use crate::{
    diagnostics::DiagnosticsSnapshot,
    domain::{RemoteUpdate, SafetyConfig},
};

/// The latest of everything (ROBOT_CPP's `logic_tick` gets sensors and health).
#[derive(Clone, Copy, Debug)]
pub struct LogicInputs<'a> {
    pub config: &'a SafetyConfig,
    pub remote: &'a RemoteUpdate,
    /// `None` without a PC link.
    pub pc: Option<&'a PcCommand>,
    /// Sensors, estimate, health and safety as of the last hundredth of a second.
    pub diagnostics: &'a DiagnosticsSnapshot,
}
