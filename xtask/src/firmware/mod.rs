//! Builds the release image that ships.

mod distribution;
pub mod image;

use std::{env, path::PathBuf, process::Command};

use anyhow::{Context, bail};

use crate::{
    job::Job,
    tool,
    workspace::{self, BOARD},
};

const PACKAGE: &str = "robot-firmware";

/// Which compiler has a core library for the board.
enum Compiler {
    /// The toolchain of `rust-toolchain.toml`.
    Rustup,
    /// The distribution's, which brings the sources of the core library: for machines on which
    /// rustup can fetch nothing.
    Distribution,
}

/// Which receiver the image listens to (`src/config.rs`).
#[derive(Clone, Copy)]
pub enum Remote {
    Sbus,
    Dbus,
}

impl Remote {
    /// As `ROBOT_REMOTE` says; SBUS if it says nothing.
    pub fn chosen() -> anyhow::Result<Self> {
        match env::var("ROBOT_REMOTE").as_deref() {
            Err(env::VarError::NotPresent) | Ok("sbus") => Ok(Self::Sbus),
            Ok("dbus") => Ok(Self::Dbus),
            other => bail!("ROBOT_REMOTE must be sbus or dbus, or unset for SBUS: it is {other:?}"),
        }
    }
}

/// The build, ready to start, and the image it makes; installs what it needs.
pub fn build(remote: Remote) -> anyhow::Result<(Job, PathBuf)> {
    let (name, word, target_dir) = match remote {
        Remote::Sbus => ("firmware", "sbus", workspace::firmware_target_dir()),
        Remote::Dbus => (
            "firmware-dbus",
            "dbus",
            workspace::dbus_firmware_target_dir(),
        ),
    };
    let mut command = match compiler()? {
        Compiler::Rustup => tool::cargo(),
        Compiler::Distribution => distribution::cargo()?,
    };
    command.args(["build", "--release", "--package", PACKAGE]);
    command.args(["--target", BOARD, "--target-dir"]);
    command.arg(&target_dir);
    command.env("ROBOT_REMOTE", word);
    let elf = target_dir.join(BOARD).join("release").join(PACKAGE);
    Ok((Job { name, command }, elf))
}

/// Clippy over the image; `None` if the toolchain of `rust-toolchain.toml` lacks the target.
pub fn clippy() -> Option<Command> {
    rustup_has_target().then(|| {
        let mut command = tool::cargo();
        command.args(["clippy", "--release", "--package", PACKAGE]);
        command.args(["--target", BOARD, "--target-dir"]);
        command.arg(workspace::firmware_target_dir());
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
