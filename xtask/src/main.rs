//! The developer commands: `cargo xtask sim`, `cargo xtask soak` and `cargo xtask test`.

mod emulator;
mod firmware;
mod job;
mod prerequisites;
mod sim;
mod soak;
mod test;
mod tool;
mod workspace;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

/// Developer commands of the robot firmware. Each installs or explains what it lacks.
#[derive(Parser)]
#[command(name = "cargo xtask")]
struct Args {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Build the release image, boot it in the emulated C board and run a scenario.
    Sim(sim::Args),
    /// Let faults from a seed have their way with the image for simulated hours.
    Soak(soak::Args),
    /// Everything CI runs: format, clippy, host tests, loom, image checks, emulator tests.
    Test,
}

fn main() -> ExitCode {
    let outcome = match Args::parse().command {
        Command::Sim(args) => sim::run(&args),
        Command::Soak(args) => soak::run(&args),
        Command::Test => test::run(),
    };
    outcome.unwrap_or_else(|error| {
        eprintln!("error: {error:#}");
        ExitCode::FAILURE
    })
}
