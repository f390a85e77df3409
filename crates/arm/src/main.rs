//! `armctl`: finds, sets up, calibrates and moves arms of serial bus servos.

mod command;
mod panel;

use std::{io, process::ExitCode};

use clap::Parser;

/// The tool for arms of serial bus servos (STS3215), such as the SO-101.
#[derive(Parser)]
#[command(version, arg_required_else_help = true, after_help = command::EXAMPLES)]
struct Arguments {
    #[command(subcommand)]
    command: command::Command,
}

fn main() -> ExitCode {
    match Arguments::parse().command.run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) if is_closed(&error) => ExitCode::SUCCESS,
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

/// True if nobody reads the output any more, as after `head`.
fn is_closed(error: &anyhow::Error) -> bool {
    let written = error.downcast_ref::<io::Error>();
    written.is_some_and(|error| error.kind() == io::ErrorKind::BrokenPipe)
}
