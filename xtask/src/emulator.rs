//! `cargo xtask sim` and `cargo xtask soak`: the release image in the emulated board.

use std::{
    path,
    process::{Command, ExitCode},
};

use anyhow::{Context, ensure};

use crate::{
    firmware::{self, Parts},
    forwarded_args::ForwardedArgs,
    host_program, job,
    prerequisites::{self, EMULATOR},
    tool, workspace,
};

/// The emulator's CPU core is written in C and has not been built for Windows.
pub const IS_BUILT_HERE: bool = !cfg!(windows);
pub const NOT_BUILT_HERE: &str = "the emulated board is not built on Windows: run it in WSL, where \
    all commands work as on Linux (docs/platforms.md)";

/// With any of these options no image is built: the user names one, or none is run.
const WITHOUT_IMAGE: [&str; 4] = ["--elf", "--help", "-h", "--list-faults"];

const ROBOT: &str = "--robot";

/// Whether a robot is given by its file, not by its name in `robots/`.
fn is_path(robot: &str) -> bool {
    robot.contains(['/', '\\', '.'])
}

/// A name, or the whole path of a file that was named from the present folder. The build runs in another one.
fn from_here(robot: &str) -> anyhow::Result<String> {
    if !is_path(robot) {
        return Ok(robot.to_owned());
    }
    let path = path::absolute(robot).with_context(|| format!("--robot {robot}"))?;
    Ok(path.to_string_lossy().into_owned())
}

/// Installs what the emulator's CPU core needs. It fails where that cannot be built.
pub fn ensure_buildable() -> anyhow::Result<()> {
    ensure!(IS_BUILT_HERE, NOT_BUILT_HERE);
    prerequisites::ensure(&EMULATOR)
}

/// Builds what is out of date and runs `program` on the image. Its exit code becomes ours.
pub fn run(program: &str, args: &ForwardedArgs) -> anyhow::Result<ExitCode> {
    ensure_buildable()?;
    let (build_emulator, path) = host_program::build("robot-sim", program)?;
    let mut jobs = vec![build_emulator];
    let mut command = Command::new(path);
    command.args(&args.words);
    if !args.has(&WITHOUT_IMAGE) {
        let wanted = args.value_of(ROBOT).map(|robot| from_here(&robot));
        let wanted = wanted.transpose()?;
        let parts = Parts::for_robot(wanted)?;
        let (build_image, elf) = firmware::build(&parts)?;
        jobs.push(build_image);
        command.arg("--elf").arg(elf);
        // Without the option the program takes the robot that the image is for. It finds no file outside of `robots/`.
        if !args.has(&[ROBOT]) && is_path(parts.robot()) {
            command
                .arg(ROBOT)
                .arg(workspace::root().join(parts.robot()));
        }
    }
    job::run_all(jobs)?;
    tool::exit_code_of(command)
}
