//! How the robot that is simulated differs from its file.

use crate::{free, time::Ps};

/// Differences between the simulated robot and its file. The default has none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Variation {
    /// Factor of the whole robot's mass. The difference sits on the body, whose inertia grows alike.
    pub mass: f64,
    /// Shift of the body's centre of mass in body axes, m.
    pub com_m: [f64; 3],
    /// Friction coefficient between wheels and plain ground.
    pub grip: f64,
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
            mass: 1.0,
            com_m: [0.0; 3],
            grip: 0.8,
            torque: 1.0,
            delay: 0,
            imu_rad: [0.0; 3],
        }
    }
}

impl Variation {
    /// What of it the mechanics have.
    pub(crate) fn of_the_body(&self) -> free::Variation {
        free::Variation {
            mass_factor: self.mass,
            com_offset_m: self.com_m,
            ground_friction: self.grip,
        }
    }
}
