//! The `base.yaml` of a robot of this project.

use robot_description::Robot;

/// A robot whose legs do not reach the middle of their heights.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error(
    "{robot}: its legs cannot be {length_m} m long with the wheel below the hips. `cargo xtask robot check` says more"
)]
pub struct OutOfReach {
    robot: String,
    length_m: f64,
}

/// Deflection in rad at which a held hip gives its torque limit.
const DEFLECTION_RAD: f64 = 0.125;
/// Damping of a held hip in N·m·s/rad, for each N·m/rad of stiffness.
const DAMPING_S: f64 = 0.025;
/// Speed error in rad/s at which a wheel gives its torque limit.
const SPEED_ERROR_RPS: f64 = 8.0;

/// Returns the text of a robot's `base.yaml`, with comments. Names are those of the robot's MJCF and URDF. The policy has the
/// hips first, then the wheels; senses are those of the PC link.
///
/// # Errors
/// The legs cannot have the length in the middle of the robot's heights.
pub fn base_yaml(robot: &Robot) -> Result<String, OutOfReach> {
    let [low_m, high_m] = robot.control.limits.height_m;
    let length_m = f64::midpoint(low_m, high_m);
    let front_rad = front_hip_rad(robot, length_m).ok_or_else(|| OutOfReach {
        robot: robot.name.clone(),
        length_m,
    })?;
    let [front, rear] = [rounded(front_rad), rounded(-front_rad)];
    let hip_nm = robot.joints.torque_limit_nm;
    let wheel_nm = robot.wheels.current_limit_a * robot.wheels.torque_nm_per_a;
    let kp = rounded((hip_nm / DEFLECTION_RAD).min(robot.joints.max_kp));
    let kd = rounded((kp * DAMPING_S).min(robot.joints.max_kd));
    let wheel_kd = rounded(wheel_nm / SPEED_ERROR_RPS);
    let wheel_nm = rounded(wheel_nm);
    let name = &robot.name;
    Ok(format!(
        "\
# What all policies of this robot have in common. A policy's config.yaml overrides it key by key (docs/policy.md).
# SI units and radians. Written from the robot's description; change what you trained otherwise.
{name}:
  # Period of the control loop in s, and its periods from one run of the network to the next: 50 runs a second.
  dt: 0.005
  decimation: 4
  # Names in the order of the motors on the PC link: the wheels, then the hips.
  num_of_dofs: 6
  joint_names: [\"left_wheel\", \"right_wheel\", \"left_front_hip\", \"left_rear_hip\", \"right_front_hip\", \"right_rear_hip\"]
  # The motor of each of the policy's joints: left front, left rear, right front, right rear hip, left, right wheel. All lists
  # below have a value for each joint, in this order.
  # Angles: 0 with the thigh level, pointing away from the other one. Front hips grow as the thigh goes up, rear hips as it
  # goes down: both turn about the body's right. Wheels grow as the robot rolls forward.
  joint_mapping: [2, 3, 4, 5, 0, 1]
  # 1, or -1 where the policy counts the other way round than the lines above say.
  joint_directions: [1, 1, 1, 1, 1, 1]
  # Which of them are wheels.
  wheel_indices: [4, 5]
  # Pose that is 0 to the policy: legs {length_m:.3} m long, wheels below the hips.
  default_dof_pos: [{front:?}, {rear:?}, {front:?}, {rear:?}, 0.0, 0.0]
  # Largest torques in N·m: the robot's own limits.
  torque_limits: [{hip_nm:?}, {hip_nm:?}, {hip_nm:?}, {hip_nm:?}, {wheel_nm:?}, {wheel_nm:?}]
  # Stiffness in N·m/rad and damping in N·m·s/rad while getting up and down. A wheel has no stiffness.
  fixed_kp: [{kp:?}, {kp:?}, {kp:?}, {kp:?}, 0.0, 0.0]
  fixed_kd: [{kd:?}, {kd:?}, {kd:?}, {kd:?}, {wheel_kd:?}, {wheel_kd:?}]
"
    ))
}

/// The angle of the front hips with the axle straight below the hip centre, the knees outward. That of the rear hips is its
/// negative.
///
/// Hip, knee and axle are a triangle of thigh, shank and the line from hip to axle. Angles count from forward, up positive.
fn front_hip_rad(robot: &Robot, length_m: f64) -> Option<f64> {
    let legs = &robot.legs;
    let [thigh_m, shank_m] = [legs.thigh.length_m, legs.shank.length_m];
    let behind_m = legs.hip_gap_m / 2.0;
    let line_m = behind_m.hypot(length_m);
    let cosine = (thigh_m.powi(2) + line_m.powi(2) - shank_m.powi(2)) / (2.0 * thigh_m * line_m);
    let towards_axle_rad = (-length_m).atan2(-behind_m);
    (cosine.abs() <= 1.0).then(|| towards_axle_rad + cosine.acos())
}

/// Three digits behind the point.
fn rounded(value: f64) -> f64 {
    (value * 1e3).round() / 1e3
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    fn robot(name: &str) -> Robot {
        let robots = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots");
        Robot::read(&robots.join(format!("{name}.toml"))).expect("a robot")
    }

    #[test]
    fn the_shank_reaches_from_the_knee_to_the_axle() {
        for name in ["fivebar", "fivebar-rs00"] {
            let robot = robot(name);
            let legs = &robot.legs;
            let angle_rad = front_hip_rad(&robot, 0.18).unwrap();
            let knee_m = [
                legs.hip_gap_m / 2.0 + legs.thigh.length_m * angle_rad.cos(),
                legs.thigh.length_m * angle_rad.sin(),
            ];
            let shank_m = knee_m[0].hypot(knee_m[1] + 0.18);
            assert!((shank_m - legs.shank.length_m).abs() < 1e-12);
            assert!(knee_m[0] > legs.hip_gap_m / 2.0, "the knee points outward");
        }
    }

    #[test]
    fn legs_that_do_not_reach_are_named() {
        let mut robot = robot("fivebar");
        robot.control.limits.height_m = [0.5, 0.6];
        let error = base_yaml(&robot).unwrap_err().to_string();
        assert!(error.starts_with("fivebar: "), "{error}");
    }
}
