//! `robotctl`: calibrates the robot's sensors, tunes, watches, records and drives it over CAN or the PC link.

mod command;

use std::process::ExitCode;

use clap::Parser;

/// The PC's tool for the robot.
#[derive(Parser)]
#[command(version, arg_required_else_help = true, after_help = command::EXAMPLES)]
struct Arguments {
    #[command(subcommand)]
    command: command::Command,
}

fn main() -> ExitCode {
    match Arguments::parse().command.run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) if command::output::is_closed(&error) => ExitCode::SUCCESS,
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
