//! What no request and no stick can exceed. Chosen so that a hand can hold any motor of the robot.

/// Torque of a joint on trial.
pub const JOINT_TORQUE_NM: f32 = 0.5;
/// Current of a wheel motor on trial: 0.3 N·m at the shaft of an M3508 with its gear (0.3 N·m/A).
pub const WHEEL_CURRENT_MA: f32 = 1_000.0;
/// A joint faster than this is let go.
pub const JOINT_SPEED_RPS: f32 = 3.0;
/// A wheel faster than this at its own shaft is let go.
pub const WHEEL_SPEED_RPS: f32 = 10.0;
/// Stiffness of a held joint, N·m/rad.
pub const HOLD_KP: f32 = 5.0;
/// Damping of a held joint, N·m·s/rad: by itself, which is what a soft limit may leave of it, 0.45 N·m at the greatest
/// speed.
pub const HOLD_KD: f32 = 0.15;
/// What stiffness and damping of a held joint may ask for together. Below the limit of a joint because the motor goes
/// on computing with its own newer angle until the next command.
pub const HOLD_TORQUE_NM: f32 = 0.45;
/// Current that brakes a held wheel, for each rad/s at its shaft.
pub const BRAKE_MA_PER_RPS: f32 = 200.0;
/// Longest torque without letting go of the dead-man stick.
pub const TORQUE_US: u64 = 3_000_000;
/// How long the dead-man stick must be let go before it counts again.
pub const RELEASE_US: u64 = 200_000;
/// A radio frame older than this holds no dead-man stick.
pub const REMOTE_AGE_US: u32 = 50_000;
/// Without a newer report of the motor on trial its speed is not known.
pub const FEEDBACK_AGE_US: u32 = 50_000;
