//! `cargo xtask replay`: recorded trials through the estimator, on this machine.

use std::process::{Command, ExitCode};

use crate::{host_program, job, passed_on::PassedOn, tool};

/// Builds `replay` if it is out of date and runs it; its exit code becomes ours. Needs neither image nor emulator.
pub fn run(args: &PassedOn) -> anyhow::Result<ExitCode> {
    let (build, path) = host_program::build("robot-replay", "replay")?;
    job::run_all(vec![build])?;
    let mut command = Command::new(path);
    command.args(&args.words);
    tool::exit_code_of(command)
}
