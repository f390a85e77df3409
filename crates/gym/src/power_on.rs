//! Robots before power-on.

use std::sync::Arc;

use robot_app::domain::RobotConfig;
use robot_description::JointMotor;
use robot_host_loop::Robots;
use robot_plant::{
    free::Start,
    robots,
    world::{PlantKind, WorldConfig},
};
use robot_policy::{Drive, PolicyDescription};

/// A robot before power-on.
#[derive(Clone)]
pub(crate) struct PowerOn {
    pub world: WorldConfig,
    pub settings: RobotConfig,
}

impl PowerOn {
    /// Robot `seed`, whose wheels may have the current that the policy wants, as far as the robot's file allows it.
    pub fn of(robots: &Robots, policy: &PolicyDescription, seed: u64, start: Start) -> Self {
        let world = WorldConfig {
            plant: PlantKind::Free,
            robot: Arc::clone(&robots.robot),
            seed,
            start,
            variation: robots.variation(seed),
            ..WorldConfig::default()
        };
        let mut settings = robots.settings();
        let wheels = &robots.robot.wheels;
        let wanted_nm = policy.joints.iter().filter(|it| it.drive == Drive::Speed);
        let wanted_nm = wanted_nm.fold(0.0, |most, it| it.torque_limit_nm.max(most));
        let wanted_a = f64::from(wanted_nm) / wheels.torque_nm_per_a;
        let limit_a = wanted_a
            .max(wheels.current_limit_a)
            .min(wheels.max_current_a);
        settings.wheel_ctrl.current_limit_ma = (limit_a * 1e3) as f32;
        Self { world, settings }
    }
}

pub(crate) fn robots(vary: bool) -> Robots {
    Robots {
        robot: robots::with_joints(JointMotor::Dm4310),
        vary,
    }
}
