//! What a tick gives.

use crate::{
    diagnostics::DiagnosticsSnapshot,
    domain::{BusId, CanFrame, RobotConfig, StateEstimate},
    safety::FlashGrant,
};

/// What one tick produced.
#[derive(Clone, Copy, Debug)]
pub struct ControlOutputs<'a> {
    /// To be sent now, or never: the next tick brings newer ones.
    pub frames: &'a [(BusId, CanFrame)],
    pub estimate: &'a StateEstimate,
    pub diagnostics: &'a DiagnosticsSnapshot,
    /// As `diagnostics.tuning.revision` counts it.
    pub config: &'a RobotConfig,
    pub flash: FlashGrant,
}
