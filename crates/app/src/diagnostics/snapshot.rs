//! The report about the whole robot, for a debugger that shows live values.

use super::{TickStats, UnknownFrames};
use crate::{
    bring_up::BringUpStatus,
    domain::{
        BalanceStatus, BlackBoxStatus, BusHealth, ChassisCommand, CrashCause, DebugProbe,
        ImuStatus, LateTasks, LinkHealth, LogicBus, OperatorState, ParamStatus, RadioLineHealth,
        RemoteDiagnostics, RemoteState, ResetCause, SensorHealth, SensorsSnapshot, StateEstimate,
        TuningStatus,
    },
    safety::{ArmingStatus, DriveEnd, MotorReadiness, SafetyStatus},
};

/// The state of the robot in one tick. It is plain data, so a debugger or the emulator can read every field by name.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct DiagnosticsSnapshot {
    /// Time of the tick.
    pub ts_us: u64,
    /// Sticks and channels.
    pub remote: RemoteState,
    /// The pilot's switches.
    pub operator: OperatorState,
    /// Quality of the radio link.
    pub remote_diag: RemoteDiagnostics,
    /// Measurements of all sensors and motors.
    pub sensors: SensorsSnapshot,
    /// Attitude and motion.
    pub estimate: StateEstimate,
    /// The last decision of the logic stage.
    pub logic: LogicBus,
    /// The commands sent in this tick, after limits and safety.
    pub command: ChassisCommand,
    /// State of arming.
    pub arming: ArmingStatus,
    /// Why the robot was last disarmed.
    pub drive_end: DriveEnd,
    /// Flags and stops of the safety policy.
    pub safety: SafetyStatus,
    /// State of the balance controller.
    pub balance: BalanceStatus,
    /// Timing of the tick.
    pub tick: TickStats,
    /// State of bring-up.
    pub bring_up: BringUpStatus,
    /// Tasks that missed their deadline.
    pub late_tasks: LateTasks,
    /// State of the tuning channel.
    pub tuning: TuningStatus,
    /// State of each bus. Index = `BusId`.
    pub can: [BusHealth; 2],
    /// Health of the IMU.
    pub imu_health: SensorHealth,
    /// Health of the magnetometer.
    pub mag_health: SensorHealth,
    /// Counters of the radio's UART.
    pub radio_line: RadioLineHealth,
    /// Heater, start-up calibration and rejected samples.
    pub imu_status: ImuStatus,
    /// State of the parameter store.
    pub params: ParamStatus,
    /// State of the black box.
    pub black_box: BlackBoxStatus,
    /// Battery voltage, 0 while not measured.
    pub battery_v: f32,
    /// How the previous run ended.
    pub last_words: CrashCause,
    /// Why the chip started.
    pub reset_cause: ResetCause,
    /// The start-up gyro calibration has finished.
    pub imu_calibrated: bool,
    /// State of the debug interface.
    pub debug_probe: DebugProbe,
    /// Motors that block arming.
    pub motors: MotorReadiness,
    /// Frames with unknown identifiers.
    pub strangers: UnknownFrames,
    /// Raw channels: see `RemoteUpdate`.
    pub remote_raw: [u16; 16],
    /// State of the PC link.
    pub link: LinkHealth,
    /// Age of the PC's last command in µs at the time of a report; `u32::MAX` before the first.
    pub pc_age_us: u32,
}
