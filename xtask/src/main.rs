//! The developer commands: `cargo xtask sim`, `soak`, `replay`, `bench` and `test`.

mod bench;
mod emulator;
mod firmware;
mod job;
mod prerequisites;
mod replay;
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
    /// Run the estimator over recorded trials: attitude at 1 kHz, its errors, plots.
    Replay(replay::Args),
    /// What the release image costs, and its estimator beside others, against their limits.
    Bench(bench::Args),
    /// Everything CI runs: format, clippy, host tests, loom, image checks, emulator tests.
    Test,
}

fn main() -> ExitCode {
    let outcome = match Args::parse().command {
        Command::Sim(args) => sim::run(&args),
        Command::Soak(args) => soak::run(&args),
        Command::Replay(args) => replay::run(&args),
        Command::Bench(args) => bench::run(&args),
        Command::Test => test::run(),
    };
    outcome.unwrap_or_else(|error| {
        eprintln!("error: {error:#}");
        ExitCode::FAILURE
    })
}
