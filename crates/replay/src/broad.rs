//! Prepares trials at 200 Hz from the MATLAB files of BROAD, the public recordings.
//!
//! BROAD is the Berlin Robust Orientation Estimation Assessment Dataset (D. Laidig, M. Caruso, A. Cereatti, T. Seel,
//! Data 6 (7), 2021, doi 10.3390/data6070072), under Creative Commons Attribution 4.0.

mod resample;
mod source;
mod target;

use std::{
    fs, io,
    path::{Path, PathBuf},
};

pub use source::SourceError;

/// The trials that the tests and the figures in the documents use.
pub const TWELVE: [&str; 12] = [
    "02_undisturbed_slow_rotation_B",
    "04_undisturbed_slow_rotation_with_breaks_A",
    "07_undisturbed_fast_rotation_B",
    "08_undisturbed_fast_rotation_with_breaks_A",
    "10_undisturbed_slow_translation_A",
    "15_undisturbed_fast_translation_A",
    "18_undisturbed_fast_translation_with_breaks_B",
    "21_undisturbed_fast_combined",
    "24_disturbed_tapping_A",
    "27_disturbed_phone_vibration_B",
    "29_disturbed_stationary_magnet_B",
    "34_disturbed_attached_magnet_3cm",
];

/// The attribution that the licence asks for, written beside the prepared trials.
const NOTICE: &str = "\
# Recorded motion

Trials of the Berlin Robust Orientation Estimation Assessment Dataset (BROAD), D. Laidig, M. Caruso, A. Cereatti, T. Seel,
Data 6 (7), 2021, doi 10.3390/data6070072. Creative Commons Attribution 4.0 International
(https://creativecommons.org/licenses/by/4.0/).

Changes: columns joined, resampled from 285.7 to 200 Hz, single precision.
";

/// A trial cannot be prepared.
#[derive(Debug, thiserror::Error)]
pub enum BroadError {
    #[error(
        "{name}.mat is neither in {folder} nor in its folder data_mat: is this a copy of the whole dataset?"
    )]
    Missing { name: String, folder: PathBuf },
    #[error("cannot use {path}")]
    Source { path: PathBuf, source: SourceError },
    #[error("cannot write {path}")]
    Write { path: PathBuf, source: io::Error },
}

/// Prepares the trial `name` of the dataset in `from`, and writes `NAME.json` and `NAME.f32.gz` into the folder `to`.
pub fn prepare(name: &str, from: &Path, to: &Path) -> Result<(), BroadError> {
    let file = format!("{name}.mat");
    let places = [from.join("data_mat").join(&file), from.join(&file)];
    let Some(path) = places.into_iter().find(|path| path.is_file()) else {
        return Err(BroadError::Missing {
            name: name.to_owned(),
            folder: from.to_owned(),
        });
    };
    let recorded = source::read(&path).map_err(|source| BroadError::Source { path, source })?;
    let columns = resample::columns(&recorded);
    target::write(name, &columns, to).map_err(|source| BroadError::Write {
        path: to.to_owned(),
        source,
    })
}

/// Writes the attribution that the licence requires.
pub fn write_notice(to: &Path) -> Result<(), BroadError> {
    let path = to.join("README.md");
    fs::write(&path, NOTICE).map_err(|source| BroadError::Write { path, source })
}
