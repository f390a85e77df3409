//! `cargo xtask bench`: what the release image and its estimator cost.

use std::{
    ffi::OsString,
    process::{Command, ExitCode},
};

use clap::Parser;

use crate::{
    emulator,
    firmware::{self, Parts},
    job, tool,
};

/// `bench` parses them.
#[derive(Parser)]
#[command(disable_help_flag = true)]
pub struct Args {
    /// The options of `bench` (see `cargo xtask bench --help`).
    #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
    passed_on: Vec<OsString>,
}

/// Builds what is out of date and runs the bench on it; its exit code becomes ours.
pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    let (build, path) = emulator::build("robot-bench", "bench")?;
    let mut jobs = vec![build];
    let mut command = Command::new(path);
    command.args(&args.passed_on);
    let asks = |words: &[&str]| args.passed_on.iter().any(|a| words.iter().any(|w| a == w));
    if !asks(&["--help", "-h"]) {
        let (build, programs) = firmware::build_filters()?;
        jobs.push(build);
        command.arg("--programs").arg(programs);
        if !asks(&["--quick", "--elf"]) {
            let (build, elf) = firmware::build(&Parts::chosen()?)?;
            jobs.push(build);
            command.arg("--elf").arg(elf);
        }
    }
    job::run_all(jobs)?;
    tool::exit_code_of(command)
}
