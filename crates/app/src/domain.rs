//! Types that all stages share. They are plain `repr(C)` data, so a debugger and the emulator can read them by name.

mod balance;
mod balance_profile;
mod black_box_status;
mod can;
mod command;
mod config;
mod crash_cause;
mod estimate;
mod health;
mod imu_status;
mod logic_bus;
mod mounting;
mod param_store;
mod pc;
mod remote;
mod remote_mapping;
mod robot_identity;
mod robot_profile;
pub mod robots;
mod sensors;
mod tuning_status;
mod wheel_defaults;

pub use balance::{BalanceState, BalanceStatus, StandPermit, StandUpPhase};
pub use balance_profile::{
    BalanceLimits, BalanceProfile, Carrier, GainSchedule, LegGeometry, MassModel,
};
pub use black_box_status::{BankState, BankStatus, BlackBoxStatus, EventKind};
pub use can::{BusId, CanFrame, MotorBuses, StandardId};
pub use command::{
    ChassisCommand, HighLevelCommand, JointCommand, JointMode, MotorCurrent, WheelCommand,
};
pub use config::{
    HeaterConfig, ImuCalibration, JointConfig, JointControllerConfig, MagCalibration,
    MountingConfig, RobotConfig, SafetyConfig, StandUpConfig, WheelControllerConfig,
    WheelOdomConfig,
};
pub use crash_cause::{CrashCause, LateTasks};
pub use estimate::StateEstimate;
pub use health::{
    BusErrorState, BusHealth, DebugProbe, RadioLineHealth, ResetCause, SensorHealth, SystemHealth,
};
pub use imu_status::{
    CalibrationState, CalibrationStatus, GyroBufferStatus, HeaterState, HeaterStatus, ImuRejects,
    ImuStatus, TemperatureGateState,
};
pub use logic_bus::LogicBus;
pub use mounting::Orientation;
pub use param_store::{FlashRequest, ParamError, ParamState, ParamStatus};
pub use pc::{JointTarget, LinkHealth, PcCommand, PcDrive, PcKind, WheelTarget};
pub use remote::{
    DriveMode, OperatorState, RemoteDiagnostics, RemoteState, RemoteUpdate, StandSwitch,
};
pub use remote_mapping::{BalanceChannel, NO_CHANNEL, RemoteChannel, RemoteMapping};
pub use robot_identity::RobotIdentity;
pub use robot_profile::RobotProfile;
pub use sensors::{
    ImuState, JointFeedback, JointState, MagState, MotorFeedback, SensorsSnapshot, WheelFeedback,
};
pub use tuning_status::TuningStatus;

/// Microseconds from `then_us` to `now_us`, saturating at both ends. A `then_us` of 0 means never and gives
/// `u32::MAX`.
pub fn age_us(then_us: u64, now_us: u64) -> u32 {
    if then_us == 0 {
        return u32::MAX;
    }
    if now_us < then_us {
        return 0;
    }
    u32::try_from(now_us.wrapping_sub(then_us)).unwrap_or(u32::MAX)
}
