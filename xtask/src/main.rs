//! The developer commands: `cargo xtask sim`, `soak`, `robot`, `replay`, `envelope`, `data`, `bench`, `run` and
//! `test`.

mod bench;
mod board;
mod emulator;
mod firmware;
mod forwarded_args;
mod host_program;
mod job;
mod prerequisites;
mod test;
mod tool;
mod toolchain;
mod workspace;

use std::process::ExitCode;

use clap::{Parser, Subcommand};
use forwarded_args::ForwardedArgs;

/// Developer commands of the robot firmware. Each one installs what it lacks, or says what to install.
#[derive(Parser)]
#[command(name = "cargo xtask")]
struct Args {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Build the release image, boot it in the emulated C board and run a scenario.
    Sim(ForwardedArgs),
    /// Run the image for simulated hours with random faults that a seed repeats.
    Soak(ForwardedArgs),
    /// Check a robot's file, show what holds, and write it for MuJoCo or as URDF.
    Robot(ForwardedArgs),
    /// Run the estimator over recorded trials and show its attitude at 1 kHz, errors and plots.
    Replay(ForwardedArgs),
    /// Let many robots, each different, stand, drive, fall and get up without the chip, and tell how many succeed.
    Envelope(ForwardedArgs),
    /// Prepare the recorded motion that tests and replay use, or say where to get it.
    Data(ForwardedArgs),
    /// Measure what the release image and its estimator cost, and compare that with limits and other filters.
    Bench(ForwardedArgs),
    /// Flash an image with probe-rs, run it and show its log. `cargo run --release` calls this.
    Run(ForwardedArgs),
    /// Run all checks of CI: format, clippy, image checks, tests of the host and the emulated board, loom.
    Test(test::Test),
}

fn main() -> ExitCode {
    let outcome = match Args::parse().command {
        Command::Sim(args) => emulator::run("sim", &args),
        Command::Soak(args) => emulator::run("soak", &args),
        Command::Robot(args) => host_program::run("robot-tool", "robot", &args),
        Command::Replay(args) => host_program::run("robot-replay", "replay", &args),
        Command::Envelope(args) => host_program::run("robot-envelope", "envelope", &args),
        Command::Data(args) => host_program::run("robot-replay", "data", &args),
        Command::Bench(args) => bench::run(&args),
        Command::Run(args) => board::run(&args),
        Command::Test(test) => test.run(),
    };
    outcome.unwrap_or_else(|error| {
        eprintln!("error: {error:#}");
        ExitCode::FAILURE
    })
}
