//! Joints of an rl_sar configuration.

use super::{ConfigError, keys::Keys};
use crate::{ActionPlan, Drive, Joint, JointMapping, NotAMapping};

const UNLIMITED: [f32; 2] = [f32::MIN, f32::MAX];

/// Reads the names of the joints. Their number is that of `num_of_dofs`.
fn names(keys: &Keys) -> Result<Vec<String>, ConfigError> {
    let count: usize = keys.get("num_of_dofs", "the number of joints, wheels included")?;
    if count == 0 {
        return Err(keys.complaint("num_of_dofs", "a policy without joints drives nothing"));
    }
    keys.per_joint(
        "joint_names",
        "the names of all joints, in the policy's order",
        count,
    )
}

/// Reads which joints are wheels.
fn drives(keys: &Keys, count: usize) -> Result<Vec<Drive>, ConfigError> {
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

/// Reads the joints with all that belongs to one of them.
pub(super) fn joints(keys: &Keys) -> Result<Vec<Joint>, ConfigError> {
    let names = names(keys)?;
    let count = names.len();
    let drives = drives(keys, count)?;
    let clips = clips(keys, count)?;
    let list = |key: &str, what: &str, least: f32| numbers(keys, key, what, least, count);
    let default_rad = list(
        "default_dof_pos",
        "default angle in rad of each joint",
        f32::MIN,
    )?;
    let kp = list(
        "rl_kp",
        "stiffness in N·m/rad of each joint, 0 of wheels",
        0.0,
    )?;
    let kd = list("rl_kd", "damping in N·m·s/rad of each joint", 0.0)?;
    let fixed_kp = list(
        "fixed_kp",
        "stiffness in N·m/rad of each joint while getting up, 0 of wheels",
        0.0,
    )?;
    let fixed_kd = list(
        "fixed_kd",
        "damping in N·m·s/rad of each joint while getting up",
        0.0,
    )?;
    let torque_limit_nm = list("torque_limits", "largest torque in N·m of each joint", 0.0)?;
    let scale = list("action_scale", "factor of each action", f32::MIN)?;
    for (key, stiffness) in [("rl_kp", &kp), ("fixed_kp", &fixed_kp)] {
        let mut pairs = drives.iter().zip(stiffness).enumerate();
        if let Some((index, (_, kp))) =
            pairs.find(|(_, (drive, kp))| **drive == Drive::Speed && **kp != 0.0)
        {
            let message = format!(
                "{} is a wheel with a stiffness of {kp}: a wheel has no angle to hold, so it is 0",
                names[index]
            );
            return Err(keys.complaint(key, message));
        }
    }
    let joints = names.into_iter().enumerate().map(|(n, name)| Joint {
        name,
        drive: drives[n],
        default_rad: default_rad[n],
        kp: kp[n],
        kd: kd[n],
        fixed_kp: fixed_kp[n],
        fixed_kd: fixed_kd[n],
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
