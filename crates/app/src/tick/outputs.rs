//! The outputs of a tick.

use crate::{
    diagnostics::{DiagnosticsSnapshot, Telemetry},
    domain::{BusId, CanFrame, RobotConfig, StateEstimate},
    safety::FlashGrant,
};

/// The outputs of one tick.
#[derive(Clone, Copy, Debug)]
pub struct ControlOutputs<'a> {
    /// Frames to send now. A frame that cannot be sent is dropped, as the next tick brings newer ones.
    pub frames: &'a [(BusId, CanFrame)],
    /// Frames of the tuning channel for the tunnel of the PC link.
    pub link_frames: &'a [CanFrame],
    /// The tick in brief, every `diagnostics::TELEMETRY_PERIOD_TICKS`.
    pub telemetry: Option<&'a Telemetry>,
    /// Attitude and motion.
    pub estimate: &'a StateEstimate,
    /// The report.
    pub diagnostics: &'a DiagnosticsSnapshot,
    /// The settings in use, with revision `diagnostics.tuning.revision`.
    pub config: &'a RobotConfig,
    /// What the parameter task may do to flash.
    pub flash: FlashGrant,
}
