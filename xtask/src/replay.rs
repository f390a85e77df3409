//! `cargo xtask replay`: recorded trials through the estimator, on this machine.

use std::{
    ffi::OsString,
    process::{Command, ExitCode},
};

use clap::Parser;

use crate::{
    emulator::HOST_PROFILE,
    job::{self, Job},
    tool, workspace,
};

/// `replay` parses them.
#[derive(Parser)]
#[command(disable_help_flag = true)]
pub struct Args {
    /// The options of `replay` (see `cargo xtask replay --help`).
    #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
    passed_on: Vec<OsString>,
}

/// Builds `replay` if it is out of date and runs it; its exit code becomes ours. Needs neither image nor emulator.
pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    let host = tool::host_triple()?;
    let mut build = tool::cargo();
    build.args(["build", "--package", "robot-replay", "--bin", "replay"]);
    build.args(["--profile", HOST_PROFILE, "--target", &host]);
    job::run_all(vec![Job {
        name: "replay".to_owned(),
        command: build,
    }])?;
    let program = workspace::host_target_dir()
        .join(&host)
        .join(HOST_PROFILE)
        .join("replay");
    let mut replay = Command::new(program);
    replay.args(&args.passed_on);
    tool::exit_code_of(replay)
}
