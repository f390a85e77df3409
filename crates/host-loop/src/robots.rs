//! Robots that differ from their file, one for each seed.

use std::sync::Arc;

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use robot_app::domain::RobotConfig;
use robot_description::Robot;
use robot_plant::{
    free,
    time::{Ps, US},
    world::Variation,
};

use crate::layout_of;

/// Span of the factor of the whole mass.
const MASS: (f64, f64) = (0.8, 1.4);
/// Largest shift of the body's centre of mass along each axis, m.
const COM_M: f64 = 0.03;
const GRIP: (f64, f64) = (0.4, 1.2);
/// Largest deviation of the motors' torque.
const TORQUE: f64 = 0.1;
const MAX_DELAY: Ps = 5_000 * US;
/// Largest error of the board's mounting about each axis, rad.
const MOUNTING_RAD: f64 = 1.0 * std::f64::consts::PI / 180.0;

/// A robot and how its specimens differ.
#[derive(Clone)]
pub struct Robots {
    /// The robot's file.
    pub robot: Arc<Robot>,
    /// Whether specimens differ from it. Sensors have noise and offsets anyway.
    pub vary: bool,
}

impl Robots {
    /// Specimen `seed`: mass −20 … +40 %, centre of mass ±3 cm along each axis, friction
    /// 0.4 … 1.2, torque ±10 %, a delay of up to 5 ms more, the board turned by up to 1° about each axis. The numbers of
    /// one seed do not depend on those before it.
    pub fn variation(&self, seed: u64) -> Variation {
        if !self.vary {
            return Variation::default();
        }
        let mut numbers = Pcg64Mcg::seed_from_u64(seed);
        let mut between = |low: f64, high: f64| numbers.random_range(low..high);
        Variation {
            body: free::Variation {
                mass_factor: between(MASS.0, MASS.1),
                com_offset_m: [
                    between(-COM_M, COM_M),
                    between(-COM_M, COM_M),
                    between(-COM_M, COM_M),
                ],
                ground_friction: between(GRIP.0, GRIP.1),
            },
            torque: between(1.0 - TORQUE, 1.0 + TORQUE),
            delay: between(0.0, MAX_DELAY as f64) as Ps,
            imu_rad: [
                between(-MOUNTING_RAD, MOUNTING_RAD),
                between(-MOUNTING_RAD, MOUNTING_RAD),
                between(-MOUNTING_RAD, MOUNTING_RAD),
            ],
        }
    }

    /// The settings of the robot: the defaults, and an RS00's own time-out set, without which it does not arm.
    ///
    /// # Panics
    /// This program was not built with the robot's file.
    pub fn settings(&self) -> RobotConfig {
        let layout = layout_of(&self.robot).expect("its file is built in");
        let mut settings = layout.default_config();
        settings.joint_ctrl.rs00_timeout_set = 1;
        settings
    }

    /// Mass of specimen `seed` in kg.
    pub fn mass_kg(&self, seed: u64) -> f64 {
        self.robot.total_mass_kg() * self.variation(seed).body.mass_factor
    }
}
