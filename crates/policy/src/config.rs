//! Files that describe a policy.

mod error;
mod joints;
mod keys;
mod rl_sar;
mod terms;

pub use error::ConfigError;

use std::path::{Path, PathBuf};

use crate::PolicyDescription;

/// Returns the folder of a policy: `policies/ROBOT/CONFIG`.
pub fn folder(policies: &Path, robot: &str, config: &str) -> PathBuf {
    policies.join(robot).join(config)
}

/// Reads the policy of a robot from `policies/ROBOT/base.yaml` and `policies/ROBOT/CONFIG/config.yaml`.
///
/// # Errors
/// A file is missing or no YAML; a key is missing, unknown, or of the wrong type or length; a term is unknown; the
/// observation has another length than `num_observations` says. The error names file, line, key and cure.
pub fn read(policies: &Path, robot: &str, config: &str) -> Result<PolicyDescription, ConfigError> {
    rl_sar::read(policies, robot, config)
}
