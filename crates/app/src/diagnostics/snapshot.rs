//! `DiagnosticsSnapshot`: everything about the robot, for a debugger that shows live values.

use super::{Strangers, TickStats};
use crate::{
    bring_up::BringUpStatus,
    domain::{
        BusHealth, ChassisCommand, CrashCause, DebugProbe, ImuStatus, LateTasks, LogicBus,
        OperatorState, ParamStatus, RadioLineHealth, RemoteDiagnostics, RemoteState, ResetCause,
        SensorHealth, SensorsSnapshot, StateEstimate, TuningStatus,
    },
    safety::{ArmingStatus, MotorReadiness, SafetyStatus},
};

/// Plain data, so that a debugger or the emulator can read every field by its name.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct DiagnosticsSnapshot {
    pub ts_us: u64,
    pub remote: RemoteState,
    pub operator: OperatorState,
    pub remote_diag: RemoteDiagnostics,
    pub sensors: SensorsSnapshot,
    pub estimate: StateEstimate,
    pub logic: LogicBus,
    /// What left the board in this tick, after limits and safety.
    pub command: ChassisCommand,
    pub arming: ArmingStatus,
    pub safety: SafetyStatus,
    pub tick: TickStats,
    pub bring_up: BringUpStatus,
    pub late_tasks: LateTasks,
    pub tuning: TuningStatus,
    /// Index = `BusId`.
    pub can: [BusHealth; 2],
    pub imu_health: SensorHealth,
    pub mag_health: SensorHealth,
    pub radio_line: RadioLineHealth,
    /// Heater, start-up calibration, rejected samples.
    pub imu_status: ImuStatus,
    pub params: ParamStatus,
    pub battery_v: f32,
    /// Of the run before this one.
    pub last_words: CrashCause,
    pub reset_cause: ResetCause,
    pub imu_calibrated: bool,
    pub debug_probe: DebugProbe,
    /// Which motors keep the robot from being armed.
    pub motors: MotorReadiness,
    /// Frames on the buses that nobody here knows.
    pub strangers: Strangers,
    /// See `RemoteUpdate`.
    pub remote_raw: [u16; 16],
}
