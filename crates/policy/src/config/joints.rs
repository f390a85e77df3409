//! Joints of an rl_sar configuration.

use super::{ConfigError, keys::Keys};
use crate::{ActionPlan, Drive, Joint, JointMapping, NotAMapping};

const UNLIMITED: [f32; 2] = [f32::MIN, f32::MAX];

/// Reads the number of joints, wheels included.
pub(super) fn count(keys: &Keys) -> Result<usize, ConfigError> {
    let key = "num_of_dofs";
    let count = keys.get(key, "the number of joints, wheels included")?;
    if count == 0 {
        return Err(keys.complaint(key, "a policy without joints drives nothing"));
    }
    Ok(count)
}

/// Reads the names of the policy's joints. The file has them in the order of the motors.
pub(super) fn names(
    keys: &Keys,
    mapping: &JointMapping,
    drives: &[Drive],
) -> Result<Vec<String>, ConfigError> {
    let key = "joint_names";
    let what = "the names of all joints, in the order of the motors";
    let of_motors: Vec<String> = keys.per_joint(key, what, drives.len())?;
    let motors = mapping.motors().iter();
    let names: Vec<String> = motors.map(|motor| of_motors[*motor].clone()).collect();
    let mut joints = names.iter().zip(drives).enumerate();
    let misnamed = joints.find(|(_, (name, drive))| {
        **drive == Drive::Position && name.to_lowercase().contains("wheel")
    });
    match misnamed {
        None => Ok(names),
        Some((index, (name, _))) => {
            let message = format!(
                "joint {index} of the policy is called {name}, and is no wheel by wheel_indices. joint_names are in the order \
                 of the motors: joint i of the policy is joint_names[joint_mapping[i]]"
            );
            Err(keys.complaint(key, message))
        }
    }
}

/// Reads which joints are wheels.
pub(super) fn drives(keys: &Keys, count: usize) -> Result<Vec<Drive>, ConfigError> {
    let what = "the indices of the wheels in joint_names, [] without wheels";
    let wheels: Vec<usize> = keys.get("wheel_indices", what)?;
    let mut drives = vec![Drive::Position; count];
    for wheel in wheels {
        match drives.get_mut(wheel) {
            Some(drive @ Drive::Position) => *drive = Drive::Speed,
            Some(Drive::Speed) => {
                return Err(keys.complaint("wheel_indices", format!("{wheel} is there twice")));
            }
            None => {
                let message = format!("there is no joint {wheel}: they are 0 to {}", count - 1);
                return Err(keys.complaint("wheel_indices", message));
            }
        }
    }
    Ok(drives)
}

/// Reads the limits of the network's values. rl_sar clips if it knows both.
fn clips(keys: &Keys, count: usize) -> Result<Vec<[f32; 2]>, ConfigError> {
    let [lower, upper] = ["clip_actions_lower", "clip_actions_upper"];
    let what = "a limit for each joint, or [] for none";
    let low: Vec<f32> = keys.find(lower, what)?.unwrap_or_default();
    let high: Vec<f32> = keys.find(upper, what)?.unwrap_or_default();
    if low.is_empty() && high.is_empty() {
        return Ok(vec![UNLIMITED; count]);
    }
    for (key, other, list) in [(lower, upper, &low), (upper, lower, &high)] {
        if list.is_empty() {
            let message = format!("{other} has no effect without it: give both, or neither");
            return Err(ConfigError::Missing {
                files: keys.files(),
                key: key.to_owned(),
                message,
            });
        }
        keys.check_length(key, list.len(), count)?;
    }
    let pairs: Vec<[f32; 2]> = low.into_iter().zip(high).map(|(l, h)| [l, h]).collect();
    match pairs.iter().position(|[low, high]| low > high) {
        None => Ok(pairs),
        Some(index) => {
            let message = format!("value {index} is above that of {upper}");
            Err(keys.complaint(lower, message))
        }
    }
}

/// Reads a list of finite numbers, one for each joint, none below `least`.
fn numbers(
    keys: &Keys,
    key: &str,
    what: &str,
    least: f32,
    count: usize,
) -> Result<Vec<f32>, ConfigError> {
    let list: Vec<f32> = keys.per_joint(key, what, count)?;
    match list.iter().find(|it| !it.is_finite() || **it < least) {
        None => Ok(list),
        Some(value) => Err(keys.complaint(key, format!("{value} is no {what}"))),
    }
}

/// Reads the period of the control loop, and how many of them are one of the network.
pub(super) fn periods(keys: &Keys) -> Result<(f32, u32), ConfigError> {
    let dt_s: f32 = keys.get("dt", "the period in s of the control loop")?;
    if !(dt_s > 0.0 && dt_s <= 1.0) {
        return Err(keys.complaint("dt", format!("{dt_s} s is no period of a control loop")));
    }
    let what = "periods of the control loop from one run of the network to the next";
    let decimation: u32 = keys.get("decimation", what)?;
    if decimation == 0 {
        return Err(keys.complaint("decimation", "0 runs the network never: it is at least 1"));
    }
    Ok((dt_s, decimation))
}

/// Reads stiffness in N·m/rad and damping in N·m·s/rad of each joint while the robot gets up.
pub(super) fn fixed_gains(
    keys: &Keys,
    names: &[String],
    drives: &[Drive],
) -> Result<Vec<[f32; 2]>, ConfigError> {
    gains(keys, ["fixed_kp", "fixed_kd"], names, drives)
}

/// Reads the largest torque in N·m of each joint.
pub(super) fn torque_limits(keys: &Keys, count: usize) -> Result<Vec<f32>, ConfigError> {
    let what = "largest torque in N·m of each joint";
    numbers(keys, "torque_limits", what, 0.0, count)
}

fn gains(
    keys: &Keys,
    [kp, kd]: [&str; 2],
    names: &[String],
    drives: &[Drive],
) -> Result<Vec<[f32; 2]>, ConfigError> {
    let count = names.len();
    let what = "stiffness in N·m/rad of each joint, 0 of wheels";
    let stiffness = numbers(keys, kp, what, 0.0, count)?;
    let what = "damping in N·m·s/rad of each joint";
    let damping = numbers(keys, kd, what, 0.0, count)?;
    let mut joints = names.iter().zip(drives).zip(&stiffness);
    if let Some(((name, _), stiffness)) =
        joints.find(|((_, drive), stiffness)| **drive == Drive::Speed && **stiffness != 0.0)
    {
        let message = format!(
            "{name} is a wheel with a stiffness of {stiffness}: a wheel has no angle to hold, so it is 0"
        );
        return Err(keys.complaint(kp, message));
    }
    Ok(stiffness
        .into_iter()
        .zip(damping)
        .map(|(kp, kd)| [kp, kd])
        .collect())
}

/// Reads the joints with all that belongs to one of them.
pub(super) fn joints(keys: &Keys, mapping: &JointMapping) -> Result<Vec<Joint>, ConfigError> {
    let count = mapping.motors().len();
    let drives = drives(keys, count)?;
    let names = names(keys, mapping, &drives)?;
    let clips = clips(keys, count)?;
    let what = "default angle in rad of each joint";
    let default_rad = numbers(keys, "default_dof_pos", what, f32::MIN, count)?;
    let own = gains(keys, ["rl_kp", "rl_kd"], &names, &drives)?;
    let fixed = fixed_gains(keys, &names, &drives)?;
    let torque_limit_nm = torque_limits(keys, count)?;
    let scale = numbers(
        keys,
        "action_scale",
        "factor of each action",
        f32::MIN,
        count,
    )?;
    let joints = names.into_iter().enumerate().map(|(n, name)| Joint {
        name,
        drive: drives[n],
        default_rad: default_rad[n],
        kp: own[n][0],
        kd: own[n][1],
        fixed_kp: fixed[n][0],
        fixed_kd: fixed[n][1],
        torque_limit_nm: torque_limit_nm[n],
        action: ActionPlan {
            clip: clips[n],
            scale: scale[n],
            offset: match drives[n] {
                Drive::Position => default_rad[n],
                Drive::Speed => 0.0,
            },
            target_range: UNLIMITED,
        },
    });
    Ok(joints.collect())
}

/// Reads which motor is which joint.
pub(super) fn mapping(keys: &Keys, count: usize) -> Result<JointMapping, ConfigError> {
    let motors = keys.per_joint("joint_mapping", "the motor's number of each joint", count)?;
    let directions = keys.find("joint_directions", "1 or -1 for each joint")?;
    let directions = directions.unwrap_or_else(|| vec![1; count]);
    JointMapping::new(motors, &directions).map_err(|error| {
        let key = match error {
            NotAMapping::Motors { .. } => "joint_mapping",
            NotAMapping::Directions { .. } => "joint_directions",
        };
        keys.complaint(key, error.to_string())
    })
}
