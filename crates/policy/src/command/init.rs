//! `policy init`: a robot's `base.yaml` from its description.

use std::{fs, path::PathBuf, process::ExitCode};

use anyhow::{Context, bail};
use robot_description::{Robot, path_of};
use robot_policy::base_yaml;

#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Init {
    /// The robot, the name of a file in robots/ or a path
    #[arg(long)]
    robot: String,
    /// Folder of policies
    #[arg(long, default_value = "policy", value_name = "FOLDER")]
    policies: PathBuf,
}

const EXAMPLES: &str = "\
It writes policy/ROBOT/base.yaml, unless there is one.

Example:
  policy init --robot fivebar-rs00
  policy init --robot robots/ours.toml --policies ../policies";

impl Init {
    pub fn run(self) -> anyhow::Result<ExitCode> {
        let robot = Robot::read(&path_of(&self.robot))?;
        let folder = self.policies.join(&robot.name);
        let file = folder.join("base.yaml");
        if file.exists() {
            bail!("{} is there already: move it away first", file.display());
        }
        let text = base_yaml(&robot)?;
        fs::create_dir_all(&folder).with_context(|| folder.display().to_string())?;
        fs::write(&file, text).with_context(|| file.display().to_string())?;
        println!("{}: written", file.display());
        Ok(ExitCode::SUCCESS)
    }
}
