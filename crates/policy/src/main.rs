//! `policy`: a trained network drives the robot.

mod command;

use std::process::ExitCode;

use clap::Parser;

/// Runs a trained network on the robot, and checks it before.
#[derive(Parser)]
#[command(version, arg_required_else_help = true, after_help = command::EXAMPLES)]
struct Arguments {
    #[command(subcommand)]
    command: command::Command,
}

fn main() -> ExitCode {
    match Arguments::parse().command.run() {
        Ok(code) => code,
        Err(error) => {
            // The reader wants to know what to do, so there is no stack trace.
            eprintln!("Error: {error}");
            for cause in error.chain().skip(1) {
                eprintln!("  because: {cause}");
            }
            ExitCode::FAILURE
        }
    }
}
