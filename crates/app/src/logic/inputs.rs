//! The inputs of a decision.

use super::PcCommand;
use crate::{
    diagnostics::DiagnosticsSnapshot,
    domain::{RemoteUpdate, SafetyConfig},
};

/// The newest value of each input.
#[derive(Clone, Copy, Debug)]
pub struct LogicInputs<'a> {
    /// Limits of ages and sticks.
    pub config: &'a SafetyConfig,
    /// Sticks, switches and link quality.
    pub remote: &'a RemoteUpdate,
    /// The PC's command, `None` without a PC link.
    pub pc: Option<&'a PcCommand>,
    /// Sensors, estimate, health and safety state, at most 10 ms old.
    pub diagnostics: &'a DiagnosticsSnapshot,
}
