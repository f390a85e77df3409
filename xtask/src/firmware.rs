//! Builds the release image that ships.

mod distribution;
pub mod image;

use std::{
    env,
    path::{Path, PathBuf},
    process::Command,
};

use anyhow::Context;

use crate::{
    job::Job,
    tool, toolchain,
    workspace::{self, BOARD},
};

const PACKAGE: &str = "robot-firmware";
const FILTERS: &str = "robot-estimator-bench";

/// A compiler that can build for the board.
enum Compiler {
    /// The toolchain of `rust-toolchain.toml`.
    Rustup,
    /// The distribution's compiler with the sources of the core library, for machines on which rustup can fetch
    /// nothing.
    Distribution,
}

/// What the image is for: a remote (`src/config.rs`) and a robot (`robots/`).
pub struct Parts {
    remote: &'static str,
    robot: String,
}

const REMOTES: [&str; 2] = ["sbus", "dbus"];

impl Parts {
    /// The parts that an image without variables is for.
    pub fn default() -> Self {
        Self::of("sbus", "fivebar")
    }

    /// The other remote and the other robot.
    pub fn other() -> Self {
        Self::of("dbus", "fivebar-rs00")
    }

    /// Returns the parts that `ROBOT_REMOTE` and `ROBOT` name.
    pub fn chosen() -> anyhow::Result<Self> {
        Self::for_robot(None)
    }

    /// Returns the same, for another robot than that of `ROBOT` if one is given.
    pub fn for_robot(robot: Option<String>) -> anyhow::Result<Self> {
        let default = Self::default();
        let remote = match variable("ROBOT_REMOTE")? {
            None => default.remote,
            Some(said) => REMOTES
                .into_iter()
                .find(|word| *word == said)
                .with_context(|| {
                    let words = REMOTES.join(" or ");
                    format!("ROBOT_REMOTE must be {words}, or unset: it is {said:?}")
                })?,
        };
        let robot = match robot {
            Some(robot) => robot,
            None => variable("ROBOT")?.unwrap_or(default.robot),
        };
        Ok(Self { remote, robot })
    }

    /// Returns the name of the robot in `robots/`, or the path of its file.
    pub fn robot(&self) -> &str {
        &self.robot
    }

    fn of(remote: &'static str, robot: &str) -> Self {
        let robot = robot.to_owned();
        Self { remote, robot }
    }

    /// Returns the target folder. Each image has its own, so that none makes another one out of date.
    fn target_dir(&self) -> PathBuf {
        let Self { remote, robot } = self;
        let default = Self::default();
        if *remote == default.remote && *robot == default.robot {
            workspace::firmware_target_dir("firmware")
        } else {
            let file = Path::new(robot).file_stem().unwrap_or_default();
            let file = file.to_string_lossy();
            workspace::firmware_target_dir(&format!("firmware-{remote}-{file}"))
        }
    }
}

/// Returns what a variable says, or `None` without it.
fn variable(name: &str) -> anyhow::Result<Option<String>> {
    match env::var(name) {
        Ok(said) => Ok(Some(said)),
        Err(env::VarError::NotPresent) => Ok(None),
        Err(error) => Err(error).context(name.to_owned()),
    }
}

/// Returns the job that builds the image, and the image's path. It installs what the build needs.
pub fn build(parts: &Parts) -> anyhow::Result<(Job, PathBuf)> {
    let target_dir = parts.target_dir();
    let mut command = cargo()?;
    command.args(["build", "--release", "--package", PACKAGE]);
    command.args(["--target", BOARD, "--target-dir"]);
    command.arg(&target_dir);
    command.env("ROBOT_REMOTE", parts.remote);
    command.env("ROBOT", &parts.robot);
    let name = target_dir.file_name().unwrap_or_default();
    let name = name.to_string_lossy().into_owned();
    let elf = target_dir.join(BOARD).join("release").join(PACKAGE);
    Ok((Job { name, command }, elf))
}

/// Does what [`build`] does for the programs of single filters, and returns their folder.
pub fn build_filters() -> anyhow::Result<(Job, PathBuf)> {
    let target_dir = workspace::firmware_target_dir(FILTERS);
    let mut command = cargo()?;
    command.args(["build", "--release", "--package", FILTERS, "--bins"]);
    command.args(["--features", "board", "--target", BOARD, "--target-dir"]);
    command.arg(&target_dir);
    let job = Job {
        name: FILTERS.to_owned(),
        command,
    };
    Ok((job, target_dir.join(BOARD).join("release")))
}

/// Returns cargo with a compiler that can build for the board.
fn cargo() -> anyhow::Result<Command> {
    match compiler()? {
        Compiler::Rustup => Ok(tool::cargo()),
        Compiler::Distribution => distribution::cargo(),
    }
}

/// Returns clippy over the image and the filters' programs, or `None` if the compiler of `rust-toolchain.toml` lacks
/// the target.
pub fn clippy() -> Option<Command> {
    let mut command = over_programs("clippy")?;
    command.args(["--", "-D", "warnings"]);
    Some(command)
}

/// Returns the command that builds their documentation. A broken link is an error.
pub fn docs() -> Option<Command> {
    let mut command = over_programs("doc")?;
    command.args(["--no-deps", "--document-private-items"]);
    command.env("RUSTDOCFLAGS", tool::RUSTDOC_FLAGS);
    Some(command)
}

/// Returns `cargo WHAT` over the image and the filters' programs. Clippy and documentation share a target folder, so
/// that dependencies are checked once.
fn over_programs(what: &str) -> Option<Command> {
    toolchain::has(BOARD).then(|| {
        let mut command = tool::cargo();
        command.args([what, "--release", "--package", PACKAGE]);
        command.args(["--package", FILTERS, "--features"]);
        command.arg(format!("{FILTERS}/board"));
        command.args(["--target", BOARD, "--target-dir"]);
        command.arg(Parts::default().target_dir());
        command
    })
}

fn compiler() -> anyhow::Result<Compiler> {
    if toolchain::has(BOARD) {
        return Ok(Compiler::Rustup);
    }
    if !distribution::is_installed() {
        if toolchain::add(BOARD) {
            return Ok(Compiler::Rustup);
        }
        distribution::install().with_context(|| {
            format!(
                "rustup cannot fetch the target {BOARD} and the distribution's compiler is not \
                 there either. With network access, `rustup target add {BOARD}` is enough"
            )
        })?;
    }
    Ok(Compiler::Distribution)
}
