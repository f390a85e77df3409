//! `cargo xtask envelope`: runs the loop without the chip, for many robots, on this machine.

use std::process::{Command, ExitCode};

use crate::{forwarded_args::ForwardedArgs, host_program, job, tool};

/// Builds the program if it is out of date and runs it. Its exit code becomes ours.
pub fn run(args: &ForwardedArgs) -> anyhow::Result<ExitCode> {
    let (build, path) = host_program::build("robot-envelope", "envelope")?;
    job::run_all(vec![build])?;
    let mut command = Command::new(path);
    command.args(&args.words);
    tool::exit_code_of(command)
}
