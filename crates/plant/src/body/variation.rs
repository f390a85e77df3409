//! How the robot that is simulated differs from its file.

use crate::{free, time::Ps};

/// Differences between the simulated robot and its file. The default has none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Variation {
    /// Of the mechanics.
    pub body: free::Variation,
    /// Factor of the torque that each motor makes of its current.
    pub torque: f64,
    /// Delay of every frame from the bus to a motor, beyond that of the motor models.
    pub delay: Ps,
    /// Turn of the board in the robot, which nobody has told the firmware: a rotation vector in body axes, rad.
    pub imu_rad: [f64; 3],
}

impl Default for Variation {
    fn default() -> Self {
        Self {
            body: free::Variation::default(),
            torque: 1.0,
            delay: 0,
            imu_rad: [0.0; 3],
        }
    }
}
