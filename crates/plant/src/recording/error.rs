//! Why a recorded trial cannot be played.

use std::{io, path::PathBuf};

use thiserror::Error;

/// A trial that cannot be read.
#[derive(Debug, Error)]
#[error("cannot read the recorded trial {path}: {defect}")]
pub struct TrialError {
    /// The trial's header file.
    pub path: PathBuf,
    /// What is wrong with it.
    pub defect: TrialDefect,
}

/// What is wrong with a trial.
#[derive(Debug, Error)]
pub enum TrialDefect {
    /// The header cannot be read.
    #[error(transparent)]
    HeaderFile(#[from] io::Error),
    /// The header is not the JSON that is expected.
    #[error(transparent)]
    Header(#[from] serde_json::Error),
    /// The header names no rows or a rate of zero.
    #[error("no rows, or no rate")]
    Empty,
    /// The data file cannot be read or unpacked.
    #[error("{file}: {source}")]
    DataFile {
        /// The file beside the header.
        file: PathBuf,
        /// What the operating system or the decoder says.
        source: io::Error,
    },
    /// The data file has another length than rows and columns of the header give.
    #[error("header speaks of {expected} bytes at {rate_num}/{rate_den} Hz, data has {found}")]
    Length {
        /// Bytes that the header promises.
        expected: usize,
        /// Bytes in the data file.
        found: usize,
        /// Numerator of the header's rate, Hz.
        rate_num: u64,
        /// Denominator of the header's rate.
        rate_den: u64,
    },
    /// Header and data do not belong together.
    #[error(
        "the data's SHA-256 is {found}, the header's sha256_raw {expected}: one of the two files is not the one that \
         was published; copy both again"
    )]
    Checksum {
        /// SHA-256 of the data, hexadecimal.
        found: String,
        /// What the header names.
        expected: String,
    },
    /// A column that every trial must have is missing.
    #[error("no column `{0}`")]
    MissingColumn(&'static str),
}
