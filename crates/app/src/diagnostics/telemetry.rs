//! What an observer at a high rate gets of a tick: the PC link and the black box.

use crate::{
    domain::{DriveMode, JointState},
    safety::{ArmingState, SafetyFlags},
};

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
    /// Measured current of each wheel, in the motor's own direction.
    pub wheel_ma: [f32; 2],
    /// Current sent to each wheel in this tick, in the motor's own direction.
    pub sent_wheel_ma: [f32; 2],
    /// Angle of each joint in rad.
    pub joint_rad: [f32; 4],
    /// Speed of each joint in rad/s.
    pub joint_rps: [f32; 4],
    /// Torque that each joint reports in N·m.
    pub joint_nm: [f32; 4],
    /// Target angle of the command that each joint follows in rad.
    pub sent_joint_rad: [f32; 4],
    /// Stiffness of that command in N·m/rad.
    pub sent_joint_kp: [f32; 4],
    /// Damping of that command in N·m·s/rad.
    pub sent_joint_kd: [f32; 4],
    /// Safety flags.
    pub flags: SafetyFlags,
    /// Age of the PC's command in µs; `u32::MAX` before the first.
    pub pc_age_us: u32,
    /// Whether the robot is armed.
    pub arming: ArmingState,
    /// Position of the mode switch.
    pub mode: DriveMode,
    /// The estimate can be trusted.
    pub estimate_valid: bool,
    /// The PC's command is in force.
    pub pc_steers: bool,
    /// State of each joint.
    pub joint_states: [JointState; 4],
}

const _: () = assert!(size_of::<Telemetry>() <= 208);
