//! What is known of motors.

use serde::Deserialize;

/// Make of the hip motors.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum JointMotor {
    /// Damiao DM4310.
    Dm4310,
    /// RobStride RS00.
    Rs00,
}
