//! Checks on any machine that the tools and the host tests compile for Windows.

use std::process::Command;

use super::totals::{self, Totals};
use crate::{host_program::HOST_PROFILE, tool, toolchain};

/// This target needs no Microsoft compiler: its core library is enough to check code.
const TARGET: &str = "x86_64-pc-windows-gnu";
/// Packages that work on Windows (docs/platforms.md).
const PACKAGES: [&str; 10] = [
    "robotctl",
    "robot-arm",
    "robot-serial-port",
    "robot-replay",
    "robot-chart",
    "robot-app",
    "robot-plant",
    "robot-snapshot",
    "robot-host-tests",
    "xtask",
];

/// Runs `cargo check` over code and tests. It is skipped where rustup cannot fetch the target.
pub fn check() -> anyhow::Result<Totals> {
    if toolchain::add(TARGET) {
        return totals::of_command(command());
    }
    println!("skipped: rustup cannot fetch {TARGET} here");
    Ok(Totals::SKIPPED)
}

fn command() -> Command {
    let mut command = tool::cargo();
    command.args(["check", "--all-targets", "--profile", HOST_PROFILE]);
    command.args(["--target", TARGET]);
    for package in PACKAGES {
        command.args(["--package", package]);
    }
    // No other step shows a warning about code that only Windows does not use.
    command.env("RUSTFLAGS", "-D warnings");
    command
}
