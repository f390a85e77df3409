//! Files that describe a policy: rl_sar's, unitree_rl_lab's `deploy.yaml`, metadata of an ONNX file.

mod base;
mod deploy;
mod error;
mod isaac;
mod joints;
mod keys;
mod metadata;
mod numbers;
mod rl_sar;
mod terms;

pub use error::ConfigError;

use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
};

use crate::PolicyDescription;

/// Name of the network's file where no configuration gives another.
pub const MODEL_FILE: &str = "policy.onnx";
/// Where unitree_rl_lab puts the network, seen from the folder of the policy.
const EXPORTED: &str = "exported/policy.onnx";

/// Returns the folder of a policy: `policies/ROBOT/CONFIG`.
pub fn folder(policies: &Path, robot: &str, config: &str) -> PathBuf {
    policies.join(robot).join(config)
}

/// Reads the policy of a robot. `policies/ROBOT/base.yaml` describes the robot, and in `policies/ROBOT/CONFIG` are either
/// `config.yaml` (rl_sar), or `deploy.yaml` or `params/deploy.yaml` (unitree_rl_lab).
///
/// # Errors
/// A file is missing or no YAML; a key is missing, unknown, or of the wrong type or length; a term is unknown; the
/// observation has another length than `num_observations` says. The error names file, key and cure.
pub fn read(policies: &Path, robot: &str, config: &str) -> Result<PolicyDescription, ConfigError> {
    let folder = folder(policies, robot, config);
    let name = format!("{robot}/{config}");
    let policy = match forms(&folder).as_slice() {
        ["config.yaml"] => rl_sar::read(policies, robot, config),
        [form @ "deploy.yaml"] => deploy::read(policies, robot, &folder.join(form), [&name, MODEL_FILE]),
        [form] => deploy::read(policies, robot, &folder.join(form), [&name, EXPORTED]),
        [] => Err(ConfigError::Malformed {
            file: folder.display().to_string(),
            message: "it has neither a config.yaml nor a deploy.yaml, and only a network with metadata does without".to_owned(),
        }),
        several => Err(ConfigError::Malformed {
            file: folder.display().to_string(),
            message: format!("which of {} describes the policy? Move the others away", several.join(", ")),
        }),
    };
    policy.and_then(numbers::check)
}

/// Returns whether a policy's folder has a file that [`read`] reads.
pub fn is_described(folder: &Path) -> bool {
    !forms(folder).is_empty()
}

/// The files of a folder that describe its policy.
fn forms(folder: &Path) -> Vec<&'static str> {
    let forms = ["config.yaml", "deploy.yaml", "params/deploy.yaml"];
    let found = forms.into_iter().filter(|form| folder.join(form).exists());
    found.collect()
}

/// Reads a policy from the metadata of its network, `policies/ROBOT/CONFIG/policy.onnx`, and from
/// `policies/ROBOT/base.yaml`.
///
/// # Errors
/// As [`read`].
pub fn from_metadata(
    policies: &Path,
    robot: &str,
    config: &str,
    metadata: &BTreeMap<String, String>,
) -> Result<PolicyDescription, ConfigError> {
    let file = folder(policies, robot, config).join(MODEL_FILE);
    let name = format!("{robot}/{config}");
    metadata::read(policies, robot, &name, &file, metadata).and_then(numbers::check)
}
