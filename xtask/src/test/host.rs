//! Cargo commands over all packages that run on this machine.

use std::{env, path::Path, process::Command};

use crate::{emulator, host_program::HOST_PROFILE, tool, workspace};

const FIRMWARE: &str = "robot-firmware";
/// Packages that need the emulator's CPU core.
const ON_THE_CORE: [&str; 3] = ["robot-emulator", "robot-sim", "robot-bench"];

/// Images that the tests of the emulated board boot.
pub struct Images<'a> {
    pub default: &'a Path,
    /// The image for a DBUS receiver and RS00 joints.
    pub other: &'a Path,
    /// Folder of the filters' programs.
    pub filters: &'a Path,
}

pub fn clippy(host: &str) -> Command {
    let mut command = over_workspace("clippy", host);
    command.args(["--all-targets", "--", "-D", "warnings"]);
    command
}

/// Builds the documentation of public and private items. A broken link is an error.
pub fn docs(host: &str) -> Command {
    let mut command = over_workspace("doc", host);
    command.args(["--no-deps", "--document-private-items"]);
    command.env("RUSTDOCFLAGS", tool::RUSTDOC_FLAGS);
    command
}

/// Tests the examples in doc comments. With the same packages as [`tests`], the features of all crates are the same too, and
/// nothing is built twice.
pub fn examples(host: &str) -> Command {
    let mut command = over_workspace("test", host);
    command.args(["--doc", "--no-fail-fast", "--", "--show-output"]);
    command
}

/// Runs all other tests, also those that boot images. They are one command, as packages that are tested apart have other
/// features of the same crates: most of these, and the emulator's CPU core, were built twice.
pub fn tests(host: &str, images: &Images<'_>, whole: bool) -> Command {
    let mut command = over_workspace("test", host);
    command.args(["--tests", "--no-fail-fast", "--", "--show-output"]);
    command.env("ROBOT_ELF", images.default);
    command.env("ROBOT_ELF_DBUS_RS00", images.other);
    command.env("ROBOT_FILTERS", images.filters);
    if whole {
        // `robot_test_support::is_whole` reads it.
        command.env("ROBOT_WHOLE", "1");
    }
    command
}

/// Runs the loom tests. Loom replaces the atomics of the snapshot by its models, so they have a target folder of their
/// own.
pub fn loom(host: &str) -> Command {
    let mut flags = env::var("RUSTFLAGS").unwrap_or_default();
    flags.push_str(" --cfg loom");
    let mut command = tool::cargo();
    command.args(["test", "--package", "robot-snapshot", "--test", "loom"]);
    command.args(["--profile", HOST_PROFILE, "--target", host, "--target-dir"]);
    command.arg(workspace::host_target_dir().join("loom"));
    command.args(["--", "--show-output"]);
    command.env("RUSTFLAGS", flags.trim());
    command
}

/// Returns `cargo WHAT` over all packages of this machine.
fn over_workspace(what: &str, host: &str) -> Command {
    let mut command = tool::cargo();
    command.args([what, "--workspace", "--exclude", FIRMWARE]);
    if !emulator::IS_BUILT_HERE {
        for package in ON_THE_CORE {
            command.args(["--exclude", package]);
        }
    }
    command.args(["--profile", HOST_PROFILE, "--target", host]);
    command
}
