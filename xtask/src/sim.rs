//! `cargo xtask sim`: boot the release image in the emulated board.

use std::{
    ffi::OsString,
    path::PathBuf,
    process::{Command, ExitCode},
};

use anyhow::Context;
use clap::Parser;

use crate::{
    emulator,
    firmware::{self, Remote},
    job,
};

/// `--elf` is looked for here only to know whether an image must be built; `sim` parses the rest.
#[derive(Parser)]
#[command(disable_help_flag = true)]
pub struct Args {
    /// A scenario file and the options of `sim` (see `cargo xtask sim --help`).
    #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
    passed_on: Vec<OsString>,
}

impl Args {
    fn needs_an_image(&self) -> bool {
        const WITHOUT: [&str; 4] = ["--elf", "--help", "-h", "--list-faults"];
        !self.passed_on.iter().any(|argument| {
            let argument = argument.to_string_lossy();
            WITHOUT.contains(&&*argument) || argument.starts_with("--elf=")
        })
    }
}

/// Builds what is out of date and runs `sim`; its exit code becomes ours.
pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    let (build_emulator, program) = emulator::build()?;
    let mut jobs = vec![build_emulator];
    let mut sim = Command::new(program);
    sim.args(&args.passed_on);
    if args.needs_an_image() {
        let (build_image, elf) = firmware::build(Remote::chosen()?)?;
        jobs.push(build_image);
        sim.arg("--elf").arg::<PathBuf>(elf);
    }
    job::run_all(jobs)?;
    let status = sim.status().context("cannot start the emulator")?;
    let code = status.code().and_then(|code| u8::try_from(code).ok());
    Ok(code.map_or(ExitCode::FAILURE, ExitCode::from))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn args(words: &[&str]) -> Args {
        Args::try_parse_from(words).expect("every word is passed on")
    }

    #[test]
    fn options_of_the_emulator_pass_through() {
        let words = [
            "sim",
            "scenarios/drive.toml",
            "--seconds",
            "3",
            "--realtime",
        ];
        assert_eq!(args(&words).passed_on, words[1..]);
    }

    #[test]
    fn an_image_is_built_unless_one_is_named_or_none_is_run() {
        assert!(args(&["sim", "--seed", "1"]).needs_an_image());
        assert!(!args(&["sim", "--elf", "a.elf"]).needs_an_image());
        assert!(!args(&["sim", "--elf=a.elf"]).needs_an_image());
        assert!(!args(&["sim", "--list-faults"]).needs_an_image());
    }
}
