//! The state that the stages of the tick share.

use crate::{
    diagnostics::{TickStats, UnknownFrames},
    domain::{BalanceStatus, OperatorState, RemoteDiagnostics, SensorsSnapshot, StateEstimate},
    safety::{ArmingStatus, MotorReadiness, SafetyStatus},
};

/// The results of the stages. Each field is written by one stage and read by those after it, in this tick or the
/// next.
#[derive(Clone, Debug, Default)]
pub struct TickState {
    pub stats: TickStats,
    pub sensors: SensorsSnapshot,
    pub estimate: StateEstimate,
    pub operator: OperatorState,
    /// The radio link, with its age as of this tick.
    pub link: RemoteDiagnostics,
    /// The sticks have been centred for long enough.
    pub sticks_centred: bool,
    /// The attitude has been undisturbed for long enough.
    pub attitude_settled: bool,
    /// Updated while the robot is disarmed.
    pub motors: MotorReadiness,
    pub safety: SafetyStatus,
    pub arming: ArmingStatus,
    /// `SIT` unless the controller ran.
    pub balance: BalanceStatus,
    pub strangers: UnknownFrames,
}
