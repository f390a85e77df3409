//! `cargo xtask robot`: everything about a robot's file.

mod check;
mod robot_file;

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
}

const EXAMPLES: &str = "\
Example:
  cargo xtask robot check fivebar
  cargo xtask robot check robots/ours.toml";

fn main() -> ExitCode {
    let outcome = match Args::parse().command {
        Command::Check(args) => check::run(&args),
    };
    outcome.unwrap_or_else(|error| {
        eprintln!("error: {error:#}");
        ExitCode::FAILURE
    })
}
