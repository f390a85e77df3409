//! Reads trials from a folder of recordings.

use std::{
    io,
    path::{Path, PathBuf},
};

use robot_plant::recording::{self, TrialError};

use crate::{
    reference::Reference,
    resample::{self, Sample},
};

#[derive(Debug, thiserror::Error)]
pub enum ReplayError {
    #[error("cannot read the folder {path}")]
    Folder { path: PathBuf, source: io::Error },
    #[error("no trial in {path}: expected files NAME.json, each with NAME.f32.gz beside it")]
    NoTrials { path: PathBuf },
    #[error("{path} holds several folders of trials, name one of them: {}", folders.join(", "))]
    SeveralFolders { path: PathBuf, folders: Vec<String> },
    #[error(transparent)]
    Trial(#[from] TrialError),
}

/// One recording, in the form in which the firmware would have measured it.
pub struct Trial {
    /// File name without extension.
    pub name: String,
    pub samples: Vec<Sample>,
    /// Number of rows in which gyro or accelerometer have no value.
    pub rows_without_motion: usize,
    /// Number of rows in which the magnetometer has no value.
    pub rows_without_field: usize,
    pub(crate) reference: Option<Reference>,
}

impl Trial {
    /// Reads the trial whose .json file is `header`. The data must have the length and the checksum that it names.
    pub fn read(header: &Path) -> Result<Self, ReplayError> {
        let recording = recording::Trial::load(header)?;
        let rows = recording.rows().iter();
        let lost = |value: &[f64; 3]| value.iter().any(|axis| !axis.is_finite());
        let without_motion = |row: &recording::Row| lost(&row.gyro_rps) || lost(&row.accel_mps2);
        let name = header.file_stem().unwrap_or_default().to_string_lossy();
        Ok(Self {
            name: name.into_owned(),
            samples: resample::samples(&recording),
            rows_without_motion: rows.clone().filter(|row| without_motion(row)).count(),
            rows_without_field: rows.filter(|row| lost(&row.field_ut)).count(),
            reference: Reference::new(&recording),
        })
    }

    pub fn seconds(&self) -> f64 {
        self.samples
            .last()
            .map_or(0.0, |sample| sample.end_us as f64 * 1e-6)
    }
}

/// Reads all trials of a folder, in the order of their names.
pub fn load(folder: &Path) -> Result<Vec<Trial>, ReplayError> {
    trial_files(folder)?
        .iter()
        .map(|file| Trial::read(file))
        .collect()
}

/// Returns the headers in `folder`, or else in the only subfolder that has any. They are in the order of their names,
/// and there is at least one.
pub fn trial_files(folder: &Path) -> Result<Vec<PathBuf>, ReplayError> {
    let here = headers(folder)?;
    if !here.is_empty() {
        return Ok(here);
    }
    let mut below = Vec::new();
    for path in entries(folder)?.into_iter().filter(|path| path.is_dir()) {
        let headers = headers(&path)?;
        if !headers.is_empty() {
            below.push((path, headers));
        }
    }
    let path = folder.to_owned();
    match below.len() {
        0 => Err(ReplayError::NoTrials { path }),
        1 => Ok(below.swap_remove(0).1),
        _ => Err(ReplayError::SeveralFolders {
            path,
            folders: below
                .iter()
                .map(|(path, _)| path.display().to_string())
                .collect(),
        }),
    }
}

fn headers(folder: &Path) -> Result<Vec<PathBuf>, ReplayError> {
    let mut files = entries(folder)?;
    files.retain(|path| {
        path.extension()
            .is_some_and(|extension| extension == "json")
    });
    Ok(files)
}

fn entries(folder: &Path) -> Result<Vec<PathBuf>, ReplayError> {
    let list = || -> io::Result<Vec<PathBuf>> {
        let entries = std::fs::read_dir(folder)?;
        let mut paths = entries
            .map(|entry| entry.map(|entry| entry.path()))
            .collect::<io::Result<Vec<_>>>()?;
        paths.sort();
        Ok(paths)
    };
    list().map_err(|source| ReplayError::Folder {
        path: folder.to_owned(),
        source,
    })
}
