//! `cargo xtask sim`: boot the release image in the emulated board.

use std::{ffi::OsString, process::ExitCode};

use clap::Parser;

use crate::emulator;

/// `sim` parses them.
#[derive(Parser)]
#[command(disable_help_flag = true)]
pub struct Args {
    /// A scenario file and the options of `sim` (see `cargo xtask sim --help`).
    #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
    passed_on: Vec<OsString>,
}

pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    emulator::run("sim", &args.passed_on)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_of_the_emulator_pass_through() {
        let words = [
            "sim",
            "scenarios/drive.toml",
            "--seconds",
            "3",
            "--realtime",
        ];
        let args = Args::try_parse_from(words).expect("every word is passed on");
        assert_eq!(args.passed_on, words[1..]);
    }
}
