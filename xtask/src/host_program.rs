//! Programs of the workspace that run on this machine.

use std::{env::consts::EXE_SUFFIX, path::PathBuf};

use crate::{job::Job, tool, workspace};

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
