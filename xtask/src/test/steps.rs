//! The steps of the test, those that fail quickest first.

use std::{path::Path, process::Command};

use super::{
    host::{self, Images},
    totals::{self, Totals},
    windows,
};
use crate::{
    emulator,
    firmware::{self, Parts, image::Image},
    job,
    prerequisites::{self, EMULATOR},
    tool,
    workspace::BOARD,
};

pub struct Step {
    pub name: &'static str,
    pub run: Box<dyn FnOnce() -> anyhow::Result<Totals>>,
}

/// Returns all steps. It installs the packages they need first, so that no step fails because one is missing.
pub fn all(whole: bool) -> anyhow::Result<Vec<Step>> {
    if emulator::IS_BUILT_HERE {
        prerequisites::ensure(&EMULATOR)?;
    }
    let host = tool::host_triple()?;
    let (build, elf) = firmware::build(&Parts::default())?;
    let (build_other, elf_other) = firmware::build(&Parts::other())?;
    let (build_filters, filters) = firmware::build_filters()?;
    let tests = host::tests(
        &host,
        &Images {
            default: &elf,
            other: &elf_other,
            filters: &filters,
        },
        whole,
    );
    Ok(vec![
        of_command("format", format()),
        step("dependencies", check_dependencies),
        of_command("clippy, host", host::clippy(&host)),
        of_command("docs, host", host::docs(&host)),
        step("check for Windows", windows::check),
        step("build the images", move || {
            job::run_all(vec![build, build_other, build_filters]).map(|()| Totals::PASSED)
        }),
        step("clippy, firmware", || on_the_board(firmware::clippy())),
        step("docs, firmware", || on_the_board(firmware::docs())),
        step("image checks", move || check_image(&elf)),
        step("tests", || all_tests(tests)),
        of_runner("examples in docs", host::examples(&host)),
        of_runner("loom", host::loom(&host)),
    ])
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

/// Where the emulated board is not built, its tests count as one that was skipped.
fn all_tests(command: Command) -> anyhow::Result<Totals> {
    let mut totals = totals::of_test_runner(command)?;
    if !emulator::IS_BUILT_HERE {
        println!("skipped: {}", emulator::NOT_BUILT_HERE);
        totals += Totals::SKIPPED;
    }
    Ok(totals)
}

fn format() -> Command {
    let mut command = tool::cargo();
    command.args(["fmt", "--all", "--check"]);
    command
}

/// Checks dependencies against `deny.toml`. Without cargo-deny, only `host-tests/tests/dependencies.rs` checks their
/// licences and sources.
fn check_dependencies() -> anyhow::Result<Totals> {
    if !prerequisites::runs("cargo-deny") {
        println!("skipped: no cargo-deny here (cargo install cargo-deny --locked)");
        return Ok(Totals::SKIPPED);
    }
    let mut command = tool::cargo();
    command.args([
        "deny",
        "--workspace",
        "check",
        "licenses",
        "bans",
        "sources",
    ]);
    totals::of_command(command)
}

/// Runs the command. `None` means that the compiler of `rust-toolchain.toml` lacks the target: the step is skipped.
fn on_the_board(command: Option<Command>) -> anyhow::Result<Totals> {
    match command {
        Some(command) => totals::of_command(command),
        None => {
            println!("skipped: rustup has no {BOARD} here");
            Ok(Totals::SKIPPED)
        }
    }
}

fn check_image(elf: &Path) -> anyhow::Result<Totals> {
    let mut sum = Totals::default();
    for check in Image::read(elf)?.checks() {
        let (verdict, found, totals) = match check.outcome {
            Ok(found) => ("ok", found, Totals::PASSED),
            Err(error) => ("FAILED", format!("{error:#}"), Totals::FAILED),
        };
        println!("{:<30} {verdict:<7} {found}", check.name);
        sum += totals;
    }
    Ok(sum)
}
