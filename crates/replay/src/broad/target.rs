//! Writes the two files of a trial.

use std::{
    fs,
    io::{self, Write},
    path::Path,
};

use flate2::{Compression, write::GzEncoder};
use serde_json::json;
use sha2::{Digest, Sha256};

use super::resample::NAMES;

/// Writes `NAME.json` and `NAME.f32.gz`. The latter holds all rows of one column, then of the next, little-endian.
pub(super) fn write(name: &str, columns: &[Vec<f32>], folder: &Path) -> io::Result<()> {
    let values = columns.iter().flatten();
    let bytes: Vec<u8> = values.flat_map(|value| value.to_le_bytes()).collect();
    let sum: String = Sha256::digest(&bytes)
        .iter()
        .map(|byte| format!("{byte:02x}"))
        .collect();
    let header = json!({
        "trial": name,
        "rows": columns.first().map_or(0, Vec::len),
        "rate_num": 200,
        "rate_den": 1,
        "columns": NAMES,
        "sha256_raw": sum,
    });
    fs::create_dir_all(folder)?;
    fs::write(folder.join(format!("{name}.json")), format!("{header:#}\n"))?;
    let mut gzip = GzEncoder::new(Vec::new(), Compression::default());
    gzip.write_all(&bytes)?;
    fs::write(folder.join(format!("{name}.f32.gz")), gzip.finish()?)
}
