//! What the stages of the tick leave for each other.

use crate::{
    diagnostics::{Strangers, TickStats},
    domain::{OperatorState, RemoteDiagnostics, SensorsSnapshot, StateEstimate},
    safety::{ArmingStatus, MotorReadiness, SafetyStatus},
};

/// The results of the stages, each written by one of them and read by those after it, in this tick or the next.
#[derive(Clone, Debug, Default)]
pub struct TickState {
    pub stats: TickStats,
    pub sensors: SensorsSnapshot,
    pub estimate: StateEstimate,
    pub operator: OperatorState,
    /// The radio link, its age as of this tick.
    pub link: RemoteDiagnostics,
    /// The sticks have been centred long enough to arm.
    pub sticks_centred: bool,
    /// The attitude has been undisturbed long enough to arm.
    pub attitude_settled: bool,
    /// Renewed while the robot is disarmed.
    pub motors: MotorReadiness,
    pub safety: SafetyStatus,
    pub arming: ArmingStatus,
    pub strangers: Strangers,
}
