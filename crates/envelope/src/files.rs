//! The files that a survey leaves.

use std::{fs, path::Path};

use anyhow::Context;

use crate::{plots, report::Report, survey::Survey, tasks::Task};

/// Writes `envelope.json` and `envelope.html` to a folder.
///
/// # Errors
/// The folder cannot be written, or a plot cannot be drawn.
pub fn write(
    folder: &Path,
    report: &Report,
    tasks: &[&Task],
    surveys: &[Survey],
) -> anyhow::Result<()> {
    fs::create_dir_all(folder).with_context(|| format!("cannot make {}", folder.display()))?;
    let put = |name: &str, text: &str| {
        let path = folder.join(name);
        fs::write(&path, text).with_context(|| format!("cannot write {}", path.display()))
    };
    put("envelope.json", &serde_json::to_string_pretty(report)?)?;
    put("envelope.html", &plots::page(report, tasks, surveys)?)
}
