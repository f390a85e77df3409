//! `robot urdf`: the robot for tools that read URDF.

use std::process::ExitCode;

use crate::{model_file::ModelFile, robot_file::RobotFile};

#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    #[command(flatten)]
    file: RobotFile,
    #[command(flatten)]
    out: ModelFile,
}

const EXAMPLES: &str = "\
Example:
  cargo xtask robot urdf fivebar --out fivebar.urdf
  yourdfpy fivebar.urdf                            # after: pip install 'yourdfpy[full]'

URDF knows no loops: the front and the rear axle of each leg are two frames that your simulator must tie.";

pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    let robot = args.file.read()?;
    args.out.write(&robot.urdf())
}
