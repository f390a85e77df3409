//! Which policy is meant.

use std::path::PathBuf;

use robot_policy::{PolicyDescription, config, model::Model};

/// A robot's policy.
#[derive(clap::Args)]
pub struct Place {
    /// Name of the robot, a folder in the folder of policies
    #[arg(long)]
    pub robot: String,
    /// Name of the policy, a folder in the robot's
    #[arg(long)]
    pub config: String,
    /// Folder of policies
    #[arg(long, default_value = "policy", value_name = "FOLDER")]
    pub policies: PathBuf,
}

impl Place {
    /// The policy, if a file other than the network describes it.
    pub fn described(&self) -> anyhow::Result<Option<PolicyDescription>> {
        let folder = config::folder(&self.policies, &self.robot, &self.config);
        let read = || config::read(&self.policies, &self.robot, &self.config);
        Ok(config::is_described(&folder).then(read).transpose()?)
    }

    /// The policy and its network, which fit.
    pub fn load(&self) -> anyhow::Result<(PolicyDescription, Model)> {
        Ok(robot_policy::load(
            &self.policies,
            &self.robot,
            &self.config,
        )?)
    }
}
