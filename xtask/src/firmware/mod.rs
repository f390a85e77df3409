//! Builds the release image that ships.

mod distribution;
pub mod image;

use std::{path::PathBuf, process::Command};

use anyhow::Context;

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

/// The build, ready to start, and the image it makes; installs what it needs.
pub fn build() -> anyhow::Result<(Job, PathBuf)> {
    let mut command = match compiler()? {
        Compiler::Rustup => tool::cargo(),
        Compiler::Distribution => distribution::cargo()?,
    };
    command.args(["build", "--release", "--package", PACKAGE]);
    command.args(["--target", BOARD, "--target-dir"]);
    command.arg(workspace::firmware_target_dir());
    let elf = workspace::firmware_target_dir()
        .join(BOARD)
        .join("release")
        .join(PACKAGE);
    let job = Job {
        name: "firmware",
        command,
    };
    Ok((job, elf))
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
