//! Finds the recordings.

use std::path::{Path, PathBuf};

use anyhow::bail;

/// The folder of recordings, seen from the repository's root.
const USUAL: &str = "../shared/data/broad";
/// The folder in it that is taken if the user names none.
const AT_200_HZ: &str = "hz200";

/// Returns the folder asked for, else the one that `ROBOT_DATA` names, else the usual one.
pub fn find(asked: Option<&Path>) -> anyhow::Result<PathBuf> {
    let (folder, said_by) = match (asked, std::env::var_os("ROBOT_DATA")) {
        (Some(folder), _) => (folder.to_owned(), "--data"),
        (None, Some(folder)) => (PathBuf::from(folder), "ROBOT_DATA"),
        (None, None) => (PathBuf::from(USUAL), "without --data and ROBOT_DATA"),
    };
    if !folder.is_dir() {
        bail!(
            "there is no folder {} ({said_by}); name the folder of recordings with --data DIR, or get some: `cargo xtask \
             data` says how",
            folder.display()
        );
    }
    let at_200_hz = folder.join(AT_200_HZ);
    Ok(match asked.is_none() && at_200_hz.is_dir() {
        true => at_200_hz,
        false => folder,
    })
}
