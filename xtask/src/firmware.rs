//! Builds the release image that ships.

mod distribution;
pub mod image;

use std::{env, path::PathBuf, process::Command};

use anyhow::Context;

use crate::{
    job::Job,
    tool,
    workspace::{self, BOARD},
};

const PACKAGE: &str = "robot-firmware";
const FILTERS: &str = "robot-estimator-bench";

/// Which compiler has a core library for the board.
enum Compiler {
    /// The toolchain of `rust-toolchain.toml`.
    Rustup,
    /// The distribution's, which brings the sources of the core library: for machines on which
    /// rustup can fetch nothing.
    Distribution,
}

/// Which parts the image is for (`src/config.rs`).
pub struct Parts {
    remote: &'static str,
    joints: &'static str,
}

impl Parts {
    /// Those that need no variable.
    pub const DEFAULT: Self = Self {
        remote: "sbus",
        joints: "dm4310",
    };
    /// All the others.
    pub const OTHER: Self = Self {
        remote: "dbus",
        joints: "rs00",
    };

    /// As `ROBOT_REMOTE` and `ROBOT_JOINTS` say.
    pub fn chosen() -> anyhow::Result<Self> {
        Ok(Self {
            remote: chosen("ROBOT_REMOTE", &["sbus", "dbus"])?,
            joints: chosen("ROBOT_JOINTS", &["dm4310", "rs00"])?,
        })
    }

    /// Its own folder, so that no image makes another one out of date.
    fn target_dir(&self) -> PathBuf {
        let Self { remote, joints } = self;
        if (*remote, *joints) == (Self::DEFAULT.remote, Self::DEFAULT.joints) {
            workspace::firmware_target_dir("firmware")
        } else {
            workspace::firmware_target_dir(&format!("firmware-{remote}-{joints}"))
        }
    }
}

/// What a variable says; without it the first of `words`.
fn chosen(variable: &str, words: &[&'static str]) -> anyhow::Result<&'static str> {
    let said = match env::var(variable) {
        Err(env::VarError::NotPresent) => words.first().copied(),
        Ok(said) => words.iter().copied().find(|word| *word == said),
        Err(env::VarError::NotUnicode(_)) => None,
    };
    said.with_context(|| {
        let words = words.join(" or ");
        format!(
            "{variable} must be {words}, or unset: it is {:?}",
            env::var(variable)
        )
    })
}

/// The build, ready to start, and the image it makes; installs what it needs.
pub fn build(parts: &Parts) -> anyhow::Result<(Job, PathBuf)> {
    let target_dir = parts.target_dir();
    let mut command = cargo()?;
    command.args(["build", "--release", "--package", PACKAGE]);
    command.args(["--target", BOARD, "--target-dir"]);
    command.arg(&target_dir);
    command.env("ROBOT_REMOTE", parts.remote);
    command.env("ROBOT_JOINTS", parts.joints);
    let name = target_dir.file_name().unwrap_or_default();
    let name = name.to_string_lossy().into_owned();
    let elf = target_dir.join(BOARD).join("release").join(PACKAGE);
    Ok((Job { name, command }, elf))
}

/// As [`build`], but the programs of single filters, and the folder they are in.
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

/// Cargo with a compiler that has a core library for the board.
fn cargo() -> anyhow::Result<Command> {
    match compiler()? {
        Compiler::Rustup => Ok(tool::cargo()),
        Compiler::Distribution => distribution::cargo(),
    }
}

/// Clippy over the image and the filters' programs; `None` if the toolchain of `rust-toolchain.toml` lacks the target.
pub fn clippy() -> Option<Command> {
    rustup_has_target().then(|| {
        let mut command = tool::cargo();
        command.args(["clippy", "--release", "--package", PACKAGE]);
        command.args(["--package", FILTERS, "--features"]);
        command.arg(format!("{FILTERS}/board"));
        command.args(["--target", BOARD, "--target-dir"]);
        command.arg(Parts::DEFAULT.target_dir());
        command.args(["--", "-D", "warnings"]);
        command
    })
}

fn compiler() -> anyhow::Result<Compiler> {
    if rustup_has_target() {
        return Ok(Compiler::Rustup);
    }
    if !distribution::is_installed() {
        eprintln!("fetching the core library for {BOARD} with rustup");
        let mut add = tool::command("rustup");
        add.args(["target", "add", BOARD]);
        if tool::succeeds(add) && rustup_has_target() {
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

fn rustup_has_target() -> bool {
    let mut rustc = tool::command("rustc");
    rustc.args(["--print", "target-libdir", "--target", BOARD]);
    tool::printed_by(rustc).is_ok_and(|dir| PathBuf::from(dir).is_dir())
}
