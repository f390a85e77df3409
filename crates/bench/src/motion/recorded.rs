//! Recorded trials (BROAD; format in the data's README.md).

use std::{fs::File, io::Read, path::Path};

use anyhow::{Context, ensure};
use serde::Deserialize;

use super::{Motion, Row, Wheels};

#[derive(Deserialize)]
struct Header {
    rows: usize,
    columns: Vec<String>,
}

impl Motion {
    pub fn read(header_path: &Path) -> anyhow::Result<Self> {
        let header: Header = serde_json::from_reader(
            File::open(header_path)
                .with_context(|| format!("cannot read {}", header_path.display()))?,
        )?;
        let mut bytes = Vec::new();
        let packed = File::open(header_path.with_extension("f32.gz"))?;
        flate2::read::GzDecoder::new(packed).read_to_end(&mut bytes)?;
        ensure!(bytes.len() == header.rows * header.columns.len() * 4);
        let values: Vec<f32> = bytes
            .chunks_exact(4)
            .map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]]))
            .collect();
        let at = |column: usize, row: usize| values[column * header.rows + row];
        let vector = |column: usize, row: usize| [0, 1, 2].map(|i| at(column + i, row));
        let rows = (0..header.rows).map(|row| {
            let q = [10, 11, 12, 13].map(|column| f64::from(at(column, row)));
            let scored = at(14, row) > 0.5 && !q[0].is_nan();
            Row {
                gyro_rps: vector(1, row),
                accel_mps2: vector(4, row),
                mag_ut: vector(7, row),
                reference_wxyz: scored.then_some(q),
            }
        });
        let stem = header_path.file_stem().unwrap_or_default();
        Ok(Self {
            name: stem.to_string_lossy().into_owned(),
            rows: rows.collect(),
            wheels: Wheels::Silent,
        })
    }
}
