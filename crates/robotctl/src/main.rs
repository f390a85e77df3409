//! `robotctl`: calibrates the robot's sensors and tunes it over CAN.

mod command;

use clap::Parser;

/// The PC's tool for the robot.
#[derive(Parser)]
#[command(version, arg_required_else_help = true)]
struct Arguments {
    #[command(subcommand)]
    command: command::Command,
}

fn main() -> anyhow::Result<()> {
    Arguments::parse().command.run()
}
