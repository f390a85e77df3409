//! `cargo xtask run`: an image on a C board, through a debug probe.

use std::process::ExitCode;

use anyhow::bail;

use crate::{forwarded_args::ForwardedArgs, prerequisites, tool};

/// Options of `probe-rs run`. By default probe-rs halts the core at each reset and fault, before the image can tell
/// the motors to stop. The board keeps that setting until it loses its power.
const OPTIONS: [&str; 5] = [
    "run",
    "--chip",
    "STM32F407IGHx",
    "--no-catch-reset",
    "--no-catch-hardfault",
];

const HOW_TO_GET_IT: &str = "\
probe-rs is not here: it flashes the board and shows its log. To get it:
  cargo install probe-rs-tools --locked
(on Debian and Ubuntu first: sudo apt-get install pkg-config libudev-dev cmake), then run the command again.
Without a board: cargo xtask sim";

/// Runs probe-rs with `args`, which are the image and more options. Its exit code becomes ours.
pub fn run(args: &ForwardedArgs) -> anyhow::Result<ExitCode> {
    if !prerequisites::runs("probe-rs") {
        bail!(HOW_TO_GET_IT);
    }
    let mut probe_rs = tool::command("probe-rs");
    probe_rs.args(OPTIONS).args(&args.words);
    tool::exit_code_of(probe_rs)
}
