//! The commands of the program; `--help` lists them.

mod bench;
mod init;
mod place;
mod show;

use std::process::ExitCode;

/// The end of the program's help.
pub const EXAMPLES: &str = "\
Example:
  policy init --robot fivebar
  policy show --robot fivebar --config flat
  policy bench policy/fivebar/flat/policy.onnx";

#[derive(clap::Subcommand)]
pub enum Command {
    /// Write a robot's base.yaml from its description
    Init(init::Init),
    /// Show what a policy sees and commands, term by term, and whether its network fits
    Show(show::Show),
    /// Measure how long a network takes, and whether it gives the same each time
    Bench(bench::Bench),
}

impl Command {
    pub fn run(self) -> anyhow::Result<ExitCode> {
        match self {
            Self::Init(init) => init.run(),
            Self::Show(show) => show.run(),
            Self::Bench(bench) => bench.run(),
        }
    }
}
