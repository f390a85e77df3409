//! `cargo xtask soak`: hours of the release image in the emulated board, under faults from a seed.

use std::{ffi::OsString, process::ExitCode};

use clap::Parser;

use crate::emulator;

/// `soak` parses them.
#[derive(Parser)]
#[command(disable_help_flag = true)]
pub struct Args {
    /// The options of `soak` (see `cargo xtask soak --help`).
    #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
    passed_on: Vec<OsString>,
}

pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    emulator::run("soak", &args.passed_on)
}
