//! Reads recorded samples of one sensor from a table of separated values or from a `run.mcap`.

mod header;
mod mcap;
mod sample;
mod table;
mod units;

use std::path::{Path, PathBuf};

pub use header::HeaderError;
pub use mcap::McapError;
pub use sample::{Sample, Sensor};
pub use table::RowError;
pub use units::UnitError;

#[derive(Debug, thiserror::Error)]
pub enum RecordingError {
    #[error("cannot read {path}")]
    File {
        path: PathBuf,
        source: std::io::Error,
    },
    #[error("{path}, line {line}: {why}")]
    Table {
        path: PathBuf,
        line: usize,
        why: RowError,
    },
    #[error("{path} is no readable MCAP file: {why}")]
    Mcap { path: PathBuf, why: McapError },
    #[error("{path} holds no samples: {expected}")]
    Empty {
        path: PathBuf,
        expected: &'static str,
    },
}

/// Reads all samples of a file, in the order of their times. A name that ends in `.mcap` is a recording of the robot or
/// the emulated board, any other a table.
pub fn load(path: &Path, sensor: Sensor) -> Result<Vec<Sample>, RecordingError> {
    load_noting(path, sensor, |_| {})
}

/// Does what [`load`] does. Where the header names no unit, `note` gets the unit that was guessed.
pub fn load_noting(
    path: &Path,
    sensor: Sensor,
    mut note: impl FnMut(&str),
) -> Result<Vec<Sample>, RecordingError> {
    let bytes = std::fs::read(path).map_err(|source| RecordingError::File {
        path: path.to_owned(),
        source,
    })?;
    let is_mcap = path
        .extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("mcap"));
    let (samples, expected) = if is_mcap {
        let samples = mcap::samples(&bytes, sensor).map_err(|why| RecordingError::Mcap {
            path: path.to_owned(),
            why,
        })?;
        (samples, "its /diag messages lack the sensor")
    } else {
        let table = table::read(&bytes, sensor).map_err(|e| RecordingError::Table {
            path: path.to_owned(),
            line: e.line,
            why: e.why,
        })?;
        table.notes.iter().for_each(|text| note(text));
        (
            table.samples,
            "no row under its header has a value of this sensor",
        )
    };
    if samples.is_empty() {
        return Err(RecordingError::Empty {
            path: path.to_owned(),
            expected,
        });
    }
    Ok(samples)
}
