//! Where a model for another program goes.

use std::{fs, path::PathBuf, process::ExitCode};

use anyhow::Context;

/// The file that is written.
#[derive(clap::Args)]
pub struct ModelFile {
    /// File to write; without it the model goes to standard output.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

impl ModelFile {
    /// Writes it.
    pub fn write(&self, text: &str) -> anyhow::Result<ExitCode> {
        match &self.out {
            Some(path) => {
                fs::write(path, text).with_context(|| path.display().to_string())?;
                println!("wrote {}", path.display());
            }
            None => print!("{text}"),
        }
        Ok(ExitCode::SUCCESS)
    }
}
