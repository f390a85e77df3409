//! What the PC link gets of a tick.

use crate::safety::{ArmingState, SafetyFlags};

/// Period of telemetry in ticks.
pub const TELEMETRY_PERIOD_TICKS: u32 = 2;

/// One tick in brief. It is copied in the tick, so values keep the units that the tick has them in.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct Telemetry {
    /// Time of the tick in µs since boot.
    pub ts_us: u64,
    /// Specific force in body axes (x forward, y left, z up) in m/s².
    pub accel_mps2: [f32; 3],
    /// Angular rate in body axes in °/s.
    pub gyro_dps: [f32; 3],
    /// Rotation from the body frame to the world frame, w first.
    pub q_wxyz: [f32; 4],
    /// Counts that each rotor has turned since its first report, 8192 a turn, in the motor's own direction.
    pub wheel_counts: [i64; 2],
    /// Rotor speed, in the motor's own direction.
    pub wheel_rpm: [i16; 2],
    /// Angle of each joint in rad.
    pub joint_rad: [f32; 4],
    /// Speed of each joint in rad/s.
    pub joint_rps: [f32; 4],
    /// Safety flags.
    pub flags: SafetyFlags,
    /// Whether the robot is armed.
    pub arming: ArmingState,
}
