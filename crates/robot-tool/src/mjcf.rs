//! `robot mjcf`: the robot for MuJoCo.

use std::process::ExitCode;

use robot_description::Hold;

use crate::{model_file::ModelFile, robot_file::RobotFile};

#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    #[command(flatten)]
    file: RobotFile,
    /// Clamp the body, with the wheels in the air.
    #[arg(long)]
    clamped: bool,
    #[command(flatten)]
    out: ModelFile,
}

const EXAMPLES: &str = "\
Example:
  cargo xtask robot mjcf fivebar --out fivebar.xml
  python3 -m mujoco.viewer --mjcf=fivebar.xml      # after: pip install mujoco";

pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    let robot = args.file.read()?;
    let hold = if args.clamped {
        Hold::Clamped
    } else {
        Hold::Free
    };
    args.out.write(&robot.mjcf(hold))
}
