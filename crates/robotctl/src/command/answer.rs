//! Asks the user at the keyboard.

use std::io;

use anyhow::{Context, Result, bail};

use super::output::begin;

/// Returns what was typed before Enter.
pub fn ask(what: &str) -> Result<String> {
    begin!("{what} Then press Enter. ")?;
    let mut line = String::new();
    let read = io::stdin().read_line(&mut line);
    if read.context("nobody answers")? == 0 {
        bail!("nobody answers");
    }
    Ok(line.trim().to_owned())
}
