//! `cargo xtask robot`: everything about a robot's file.

mod check;
mod gains;
mod mjcf;
mod model_file;
mod robot_file;
mod urdf;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

/// Look at a robot's file (docs/your-robot.md).
#[derive(Parser)]
#[command(name = "robot", bin_name = "cargo xtask robot", after_help = EXAMPLES)]
struct Args {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Show what holds of a robot, by how much, and what does not.
    Check(check::Args),
    /// Show the gains of the balance controller, with margins and plots.
    Gains(gains::Args),
    /// Write the robot as MJCF, for MuJoCo.
    Mjcf(mjcf::Args),
    /// Write the robot as URDF, with open loops.
    Urdf(urdf::Args),
}

const EXAMPLES: &str = "\
Example:
  cargo xtask robot check fivebar
  cargo xtask robot gains fivebar
  cargo xtask robot check robots/ours.toml";

fn main() -> ExitCode {
    let outcome = match Args::parse().command {
        Command::Check(args) => check::run(&args),
        Command::Gains(args) => gains::run(&args),
        Command::Mjcf(args) => mjcf::run(&args),
        Command::Urdf(args) => urdf::run(&args),
    };
    outcome.unwrap_or_else(|error| {
        eprintln!("error: {error:#}");
        ExitCode::FAILURE
    })
}
