//! Limits that no request and no stick can exceed. They are chosen so that a hand can hold any motor of the robot.

/// Torque limit of a joint.
pub const JOINT_TORQUE_NM: f32 = 0.5;
/// Current limit of a wheel motor: 0.3 N·m at the shaft of an M3508 with its gear (0.3 N·m/A).
pub const WHEEL_CURRENT_MA: f32 = 1_000.0;
/// Speed at which a joint is released.
pub const JOINT_SPEED_RPS: f32 = 3.0;
/// Speed at its own shaft at which a wheel is released.
pub const WHEEL_SPEED_RPS: f32 = 10.0;
/// Stiffness of a held joint, N·m/rad.
pub const HOLD_KP: f32 = 5.0;
/// Damping of a held joint in N·m·s/rad. A soft limit may leave only the damping, which then gives 0.45 N·m at the
/// speed limit.
pub const HOLD_KD: f32 = 0.15;
/// Torque that stiffness and damping of a held joint may request together. It is below the limit of a joint, as the
/// motor continues with its own newer angle until the next command.
pub const HOLD_TORQUE_NM: f32 = 0.45;
/// Braking current of a held wheel in mA per rad/s at its shaft.
pub const BRAKE_MA_PER_RPS: f32 = 200.0;
/// Longest time of torque without releasing the dead-man stick.
pub const TORQUE_US: u64 = 3_000_000;
/// Time for which the dead-man stick must be released before it counts again.
pub const RELEASE_US: u64 = 200_000;
/// Maximum age of a radio frame for the dead-man stick.
pub const REMOTE_AGE_US: u32 = 50_000;
/// Maximum age of the motor's report. Beyond it the speed is unknown.
pub const FEEDBACK_AGE_US: u32 = 50_000;
