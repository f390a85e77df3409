//! `cargo xtask replay` and `cargo xtask data`: run programs on recorded motion, on this machine.

use std::process::{Command, ExitCode};

use crate::{forwarded_args::ForwardedArgs, host_program, job, tool};

/// Builds `program` if it is out of date and runs it. It needs neither image nor emulator. Its exit code becomes ours.
pub fn run(program: &str, args: &ForwardedArgs) -> anyhow::Result<ExitCode> {
    let (build, path) = host_program::build("robot-replay", program)?;
    job::run_all(vec![build])?;
    let mut command = Command::new(path);
    command.args(&args.words);
    tool::exit_code_of(command)
}
