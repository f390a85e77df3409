//! `robotctl plot`: shows a recording as a page.

use std::path::PathBuf;

use anyhow::{Context, Result};
use robotctl::plot;

use super::output::say;

#[derive(clap::Args)]
pub struct Plot {
    /// Recording of `robotctl record`: MCAP, or a table for calibration
    file: PathBuf,
    /// Page to write [default: beside the file, with the ending .html]
    #[arg(long, short)]
    out: Option<PathBuf>,
}

impl Plot {
    pub fn run(self) -> Result<()> {
        let page = plot::page(&self.file)?;
        let beside = || self.file.with_extension("html");
        let out = self.out.clone().unwrap_or_else(beside);
        std::fs::write(&out, page).with_context(|| format!("cannot write {}", out.display()))?;
        say!("written to {}: open it in a browser", out.display())?;
        Ok(())
    }
}
