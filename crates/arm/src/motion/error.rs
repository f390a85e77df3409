//! What can be wrong with a recorded motion.

use std::{io, path::PathBuf};

#[derive(Debug, thiserror::Error)]
pub enum MotionError {
    #[error("cannot read {path}: {source}")]
    Read { path: PathBuf, source: io::Error },
    #[error("cannot write {path}: {source}")]
    Write { path: PathBuf, source: io::Error },
    #[error("{path} is no recorded motion: {source}. `armctl record` makes one")]
    Json {
        path: PathBuf,
        source: serde_json::Error,
    },
    #[error("{path}: {source}")]
    Mcap {
        path: PathBuf,
        source: mcap::McapError,
    },
    #[error("{path}: {source}")]
    Content {
        path: PathBuf,
        source: Box<MotionError>,
    },
    #[error("{path} ends neither in .json nor in .mcap: its ending says what it is")]
    Ending { path: PathBuf },
    #[error("there is no sample in it: record the motion again")]
    Empty,
    #[error("sample {number} has {has} positions for {joints} joints")]
    Length {
        number: usize,
        has: usize,
        joints: usize,
    },
    #[error(
        "sample {number} is at {time_s} s, after one at {last_s} s: times are finite and never go back"
    )]
    Time {
        number: usize,
        time_s: f64,
        last_s: f64,
    },
    #[error("sample {number} has no position of {joint}: all samples have the joints of the first")]
    Joint { number: usize, joint: String },
}
