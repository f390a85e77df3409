//! The commands of the program; `--help` lists them.

mod bench;
mod check;
mod init;
mod place;
mod priority;
mod run;
mod show;

use std::process::ExitCode;

/// The end of the program's help.
pub const EXAMPLES: &str = "\
Example:
  policy init --robot fivebar
  policy show --robot fivebar --config flat
  policy bench policy/fivebar/flat/policy.onnx
  policy check --robot fivebar --config flat --link /dev/ttyUSB0
  policy run --robot fivebar --config flat --link /dev/ttyUSB0 --dry-run";

#[derive(clap::Subcommand)]
pub enum Command {
    /// Write a robot's base.yaml from its description
    Init(init::Init),
    /// Show what a policy sees and commands, term by term, and whether its network fits
    Show(show::Show),
    /// Measure how long a network takes, and whether it gives the same each time
    Bench(bench::Bench),
    /// Compare a policy's joints with the robot's: order, sense, default pose
    Check(check::Check),
    /// Let a policy drive the robot
    Run(run::Run),
}

impl Command {
    pub fn run(self) -> anyhow::Result<ExitCode> {
        match self {
            Self::Init(init) => init.run(),
            Self::Show(show) => show.run(),
            Self::Bench(bench) => bench.run(),
            Self::Check(check) => check.run(),
            Self::Run(run) => run.run(),
        }
    }
}
