//! Programs of the workspace that run on this machine.

use std::{
    env::consts::EXE_SUFFIX,
    path::PathBuf,
    process::{Command, ExitCode},
};

use crate::{
    forwarded_args::ForwardedArgs,
    job::{self, Job},
    tool, workspace,
};

/// Cargo profile of everything that runs on this machine. It builds fast and runs fast enough.
pub const HOST_PROFILE: &str = "host";

/// Returns the job that builds a program, and the program's path.
pub fn build(package: &str, program: &str) -> anyhow::Result<(Job, PathBuf)> {
    let host = tool::host_triple()?;
    let mut command = tool::cargo();
    command.args(["build", "--package", package, "--bin", program]);
    command.args(["--profile", HOST_PROFILE, "--target", &host]);
    let path = workspace::host_target_dir()
        .join(&host)
        .join(HOST_PROFILE)
        .join(format!("{program}{EXE_SUFFIX}"));
    let job = Job {
        name: package.to_owned(),
        command,
    };
    Ok((job, path))
}

/// Builds a program that needs neither image nor emulator if it is out of date, and runs it. Its exit code becomes ours.
pub fn run(package: &str, program: &str, args: &ForwardedArgs) -> anyhow::Result<ExitCode> {
    let (build, path) = build(package, program)?;
    job::run_all(vec![build])?;
    let mut command = Command::new(path);
    command.args(&args.words);
    tool::exit_code_of(command)
}
