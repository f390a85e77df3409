//! What is tested, in the order of what fails quickest.

use std::{env, path::Path, process::Command};

use super::totals::{self, Totals};
use crate::{
    firmware::{self, Parts, image::Image},
    host_program::HOST_PROFILE,
    job,
    prerequisites::{self, EMULATOR},
    tool, workspace,
};

const FIRMWARE: &str = "robot-firmware";
/// Packages whose tests need images: the emulated board, and what counts in it.
const EMULATED: [&str; 2] = ["robot-sim", "robot-bench"];

pub struct Step {
    pub name: &'static str,
    pub run: Box<dyn FnOnce() -> anyhow::Result<Totals>>,
}

/// All steps. Packages are installed before, so that no step fails for the want of one.
pub fn all() -> anyhow::Result<Vec<Step>> {
    prerequisites::ensure(&EMULATOR)?;
    let host = tool::host_triple()?;
    let (build, elf) = firmware::build(&Parts::DEFAULT)?;
    let (build_other, elf_other) = firmware::build(&Parts::OTHER)?;
    let (build_filters, filters) = firmware::build_filters()?;
    let (checked, booted) = (elf.clone(), elf);
    let mut steps = vec![
        of_command("format", cargo(&["fmt", "--all", "--check"])),
        step("dependencies", check_dependencies),
        of_command("clippy, host", clippy_host(&host)),
        step("build the images", move || {
            job::run_all(vec![build, build_other, build_filters]).map(|()| Totals::PASSED)
        }),
        step("clippy, firmware", || match firmware::clippy() {
            Some(command) => totals::of_command(command),
            None => {
                println!("skipped: rustup has no {} here", workspace::BOARD);
                Ok(Totals::SKIPPED)
            }
        }),
        step("image checks", move || check_image(&checked)),
    ];
    let host_tests = test_host(&host);
    let loom = loom(&host);
    let emulator_tests = test_emulator(&host, &booted, &elf_other, &filters);
    steps.push(of_runner("host tests", host_tests));
    steps.push(of_runner("loom", loom));
    steps.push(of_runner("emulator tests", emulator_tests));
    Ok(steps)
}

fn step(name: &'static str, run: impl FnOnce() -> anyhow::Result<Totals> + 'static) -> Step {
    Step {
        name,
        run: Box::new(run),
    }
}

fn of_command(name: &'static str, command: Command) -> Step {
    step(name, || totals::of_command(command))
}

fn of_runner(name: &'static str, command: Command) -> Step {
    step(name, || totals::of_test_runner(command))
}

fn cargo(arguments: &[&str]) -> Command {
    let mut command = tool::cargo();
    command.args(arguments);
    command
}

/// Against `deny.toml`. Without cargo-deny, `host-tests/tests/dependencies.rs` alone looks at licences and sources.
fn check_dependencies() -> anyhow::Result<Totals> {
    if !prerequisites::runs("cargo-deny") {
        println!("skipped: no cargo-deny here (cargo install cargo-deny --locked)");
        return Ok(Totals::SKIPPED);
    }
    totals::of_command(cargo(&[
        "deny",
        "--workspace",
        "check",
        "licenses",
        "bans",
        "sources",
    ]))
}

fn clippy_host(host: &str) -> Command {
    cargo(&[
        "clippy",
        "--workspace",
        "--exclude",
        FIRMWARE,
        "--all-targets",
        "--profile",
        HOST_PROFILE,
        "--target",
        host,
        "--",
        "-D",
        "warnings",
    ])
}

fn test_host(host: &str) -> Command {
    cargo(&[
        "test",
        "--workspace",
        "--exclude",
        FIRMWARE,
        "--exclude",
        EMULATED[0],
        "--exclude",
        EMULATED[1],
        "--profile",
        HOST_PROFILE,
        "--target",
        host,
        "--no-fail-fast",
        "--",
        "--show-output",
    ])
}

fn test_emulator(host: &str, elf: &Path, elf_other: &Path, filters: &Path) -> Command {
    let mut command = cargo(&[
        "test",
        "--package",
        EMULATED[0],
        "--package",
        EMULATED[1],
        "--profile",
        HOST_PROFILE,
        "--target",
        host,
        "--no-fail-fast",
        "--",
        "--show-output",
    ]);
    command.env("ROBOT_ELF", elf);
    command.env("ROBOT_ELF_DBUS_RS00", elf_other);
    command.env("ROBOT_FILTERS", filters);
    command
}

/// Loom replaces the atomics of the snapshot by modelled ones, so everything is built apart.
fn loom(host: &str) -> Command {
    let mut flags = env::var("RUSTFLAGS").unwrap_or_default();
    flags.push_str(" --cfg loom");
    let mut command = cargo(&[
        "test",
        "--package",
        "robot-snapshot",
        "--test",
        "loom",
        "--profile",
        HOST_PROFILE,
        "--target",
        host,
        "--target-dir",
    ]);
    command.arg(workspace::host_target_dir().join("loom"));
    command.args(["--", "--show-output"]);
    command.env("RUSTFLAGS", flags.trim());
    command
}

fn check_image(elf: &Path) -> anyhow::Result<Totals> {
    let mut sum = Totals::default();
    for check in Image::read(elf)?.checks() {
        let (verdict, found, totals) = match check.outcome {
            Ok(found) => ("ok", found, Totals::PASSED),
            Err(wrong) => ("FAILED", wrong, Totals::FAILED),
        };
        println!("{:<30} {verdict:<7} {found}", check.name);
        sum += totals;
    }
    Ok(sum)
}
