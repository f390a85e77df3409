//! Files of the form that rl_sar reads: `base.yaml` of a robot, and `config.yaml` of a policy that overrides it key by key.

use std::path::Path;

use super::{
    ConfigError, folder, joints,
    keys::{KNOWN, Keys},
    terms::Terms,
};
use crate::{Group, HistoryOrder, PolicyDescription, TermPlan};

/// More frames than any network takes; a number above is a slip.
const MOST_FRAMES: usize = 1_000;

/// Reads `policies/ROBOT/base.yaml` and `policies/ROBOT/CONFIG/config.yaml`.
pub(super) fn read(
    policies: &Path,
    robot: &str,
    config: &str,
) -> Result<PolicyDescription, ConfigError> {
    let name = format!("{robot}/{config}");
    let keys = Keys::default()
        .read_below(&policies.join(robot).join("base.yaml"), robot)?
        .read_below(&folder(policies, robot, config).join("config.yaml"), &name)?;
    keys.know_only(&KNOWN)?;
    let mapping = joints::mapping(&keys, joints::count(&keys)?)?;
    let joints = joints::joints(&keys, &mapping)?;
    let (control_period_s, decimation) = joints::periods(&keys)?;
    let policy = PolicyDescription {
        name,
        model_file: keys.get("model_name", "the network's file, beside config.yaml")?,
        control_period_s,
        decimation,
        mapping,
        observation: observation(&keys, &joints)?,
        command_ranges: command_ranges(&keys)?,
        joints,
    };
    check_num_observations(&keys, &policy)?;
    Ok(policy)
}

fn observation(keys: &Keys, joints: &[crate::Joint]) -> Result<Vec<Group>, ConfigError> {
    let what = "a list of terms";
    let stacked: Vec<String> = keys.get("observations", what)?;
    let nonstack: Vec<String> = keys
        .find("observations_nonstack", what)?
        .unwrap_or_default();
    let terms = Terms::new(keys, joints, &[&stacked, &nonstack])?;
    let (ages, order) = history(keys)?;
    let groups = [
        Group {
            terms: terms.plan("observations", &stacked)?,
            ages,
            order,
        },
        Group {
            terms: terms.plan("observations_nonstack", &nonstack)?,
            ages: vec![0],
            order: HistoryOrder::Time,
        },
    ];
    let groups: Vec<_> = groups
        .into_iter()
        .filter(|it| !it.terms.is_empty())
        .collect();
    if groups.is_empty() {
        return Err(keys.complaint("observations", "a policy that sees nothing: list its terms"));
    }
    Ok(groups)
}

/// Reads the ages of the frames. Without a list there is the frame of now.
fn history(keys: &Keys) -> Result<(Vec<usize>, HistoryOrder), ConfigError> {
    let key = "observations_history";
    let ages: Vec<usize> = keys
        .find(key, "a list of ages, 0 for the newest frame")?
        .unwrap_or_default();
    if let Some(age) = ages.iter().find(|age| **age >= MOST_FRAMES) {
        return Err(keys.complaint(key, format!("{age} frames ago is too long ago")));
    }
    if ages.is_empty() {
        return Ok((vec![0], HistoryOrder::Time));
    }
    let key = "observations_history_priority";
    let what = "\"time\" (frame after frame) or \"term\" (term after term), needed with observations_history";
    let order: String = keys.get(key, what)?;
    match order.as_str() {
        "time" => Ok((ages, HistoryOrder::Time)),
        "term" => Ok((ages, HistoryOrder::Term)),
        other => Err(keys.complaint(key, format!("it is {what}, and not {other:?}"))),
    }
}

/// Reads the limits of commands. Without them there are none.
fn command_ranges(keys: &Keys) -> Result<[[f32; 2]; 3], ConfigError> {
    let what = "three limits: forward in m/s, left in m/s, turn left in rad/s";
    let lower: Option<[f32; 3]> = keys.find("commands_lower", what)?;
    let upper: Option<[f32; 3]> = keys.find("commands_upper", what)?;
    let lower = lower.unwrap_or([f32::MIN; 3]);
    let upper = upper.unwrap_or([f32::MAX; 3]);
    let ranges = std::array::from_fn(|n| [lower[n], upper[n]]);
    if ranges.iter().all(|[low, high]| low <= high) {
        Ok(ranges)
    } else {
        Err(keys.complaint("commands_lower", "a value is above that of commands_upper"))
    }
}

/// Compares `num_observations` with the terms. In some files it is the length of a frame, in others that of the input.
fn check_num_observations(keys: &Keys, policy: &PolicyDescription) -> Result<(), ConfigError> {
    let key = "num_observations";
    let Some(said) = keys.find::<usize>(key, "the number of values of a frame or of the input")?
    else {
        return Ok(());
    };
    let frame = policy.observation.iter().flat_map(|group| &group.terms);
    let frame: usize = frame.map(TermPlan::len).sum();
    let stacked = policy.observation.first().map_or(0, |group| {
        group.terms.iter().map(TermPlan::len).sum::<usize>()
    });
    if said == frame || said == stacked {
        return Ok(());
    }
    let layout = crate::observation::Layout::new(policy);
    layout.check(said).map_err(|mismatch| {
        let message = format!(
            "{said} is neither the length of a frame ({stacked}, with observations_nonstack {frame}) nor that of the \
             input. As the length of the input: {mismatch}"
        );
        keys.complaint(key, message)
    })
}
