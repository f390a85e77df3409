//! `robot check`: what holds of a robot, and by how much.

use std::process::ExitCode;

use crate::robot_file::RobotFile;

#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    #[command(flatten)]
    file: RobotFile,
}

const EXAMPLES: &str = "\
Example:
  cargo xtask robot check fivebar-rs00";

pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    let robot = args.file.read()?;
    println!("{}: {:.2} kg", robot.name, robot.total_mass_kg());
    Ok(ExitCode::SUCCESS)
}
