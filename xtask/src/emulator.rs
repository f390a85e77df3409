//! Builds the emulator's `sim` program.

use std::path::PathBuf;

use crate::{
    job::Job,
    prerequisites::{self, EMULATOR},
    tool, workspace,
};

/// Cargo profile of everything that runs on this machine: quick to build, quick enough to run.
pub const HOST_PROFILE: &str = "host";

/// The build, ready to start; installs what it needs.
pub fn build() -> anyhow::Result<(Job, PathBuf)> {
    prerequisites::ensure(&EMULATOR)?;
    let host = tool::host_triple()?;
    let mut command = tool::cargo();
    command.args(["build", "--package", "robot-emulator", "--bin", "sim"]);
    command.args(["--profile", HOST_PROFILE, "--target", &host]);
    let program = workspace::host_target_dir()
        .join(&host)
        .join(HOST_PROFILE)
        .join("sim");
    let job = Job {
        name: "emulator",
        command,
    };
    Ok((job, program))
}
