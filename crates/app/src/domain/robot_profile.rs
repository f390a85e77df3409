//! What the firmware knows of a robot, apart from its motors.

use super::{BalanceProfile, MountingConfig, WheelOdomConfig};

/// Figures of a robot from its file (docs/your-robot.md). The motors are in `motor::layout`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RobotProfile {
    /// Name, as in `ROBOT=name`.
    pub name: &'static str,
    /// Tells the file from others; see `Robot::fingerprint` of robot-description.
    pub fingerprint: u64,
    /// Geometry of the wheels as delivered.
    pub wheel_odom: WheelOdomConfig,
    /// Limit of each wheel's current in mA as delivered.
    pub wheel_current_ma: f32,
    /// How the sensors are mounted as delivered.
    pub mounting: MountingConfig,
    /// Height of the IMU above the hip centre in m.
    pub imu_up_m: f32,
    /// What balancing needs.
    pub balance: BalanceProfile,
}
