//! The keys that say which robot it is and how it differs from its file: `robot`, `joints`, `variation`.

use std::{path::Path, sync::Arc};

use robot_description::Robot;
use robot_plant::{
    free,
    robots::{self, JointMotor},
    time,
    world::Variation,
};
use serde::Deserialize;

use super::Problem;

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Joints {
    Dm4310,
    Rs00,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Vary {
    mass: Option<f64>,
    com_m: Option<[f64; 3]>,
    grip: Option<f64>,
    torque: Option<f64>,
    delay_ms: Option<f64>,
    imu_deg: Option<[f64; 3]>,
}

/// The robot of the file `robot`, or of this repository with these joints. `robot` is a path, or a name in `robots/`.
pub(super) fn read_robot(
    robot: Option<&str>,
    joints: Option<Joints>,
) -> Result<Arc<Robot>, Problem> {
    match (robot, joints) {
        (Some(_), Some(_)) => Err(Problem::RobotAndJoints),
        (Some(robot), None) => open(robot),
        (None, Some(Joints::Rs00)) => Ok(robots::with_joints(JointMotor::Rs00)),
        (None, Some(Joints::Dm4310) | None) => Ok(robots::with_joints(JointMotor::Dm4310)),
    }
}

fn open(robot: &str) -> Result<Arc<Robot>, Problem> {
    let read = Robot::read(&robot_description::path_from(Path::new(ROOT), robot));
    let read = read.map_err(|error| Problem::Robot(error.to_string()))?;
    Ok(Arc::new(read))
}

pub(super) fn read_variation(raw: &Vary) -> Result<Variation, Problem> {
    let plain = Variation::default();
    let body = plain.body;
    let shift_m = raw.com_m.unwrap_or(body.com_offset_m);
    for part in shift_m {
        within("com_m", part, [-0.2, 0.2])?;
    }
    let turn_deg = raw.imu_deg.unwrap_or_default();
    for part in turn_deg {
        within("imu_deg", part, [-10.0, 10.0])?;
    }
    let delay_ms = within("delay_ms", raw.delay_ms.unwrap_or(0.0), [0.0, 50.0])?;
    Ok(Variation {
        body: free::Variation {
            mass_factor: within("mass", raw.mass.unwrap_or(body.mass_factor), [0.7, 2.0])?,
            com_offset_m: shift_m,
            ground_friction: within(
                "grip",
                raw.grip.unwrap_or(body.ground_friction),
                [0.01, 2.0],
            )?,
        },
        torque: within("torque", raw.torque.unwrap_or(plain.torque), [0.1, 2.0])?,
        delay: time::from_seconds(delay_ms * 1e-3),
        imu_rad: turn_deg.map(f64::to_radians),
    })
}

fn within(name: &'static str, value: f64, [least, most]: [f64; 2]) -> Result<f64, Problem> {
    if (least..=most).contains(&value) {
        return Ok(value);
    }
    Err(Problem::Variation {
        name,
        value,
        least,
        most,
    })
}
