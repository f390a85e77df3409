//! Writes rows as a recording that the sensor models play: a JSON header beside gzipped columns.

use std::{
    fs,
    io::Write,
    path::{Path, PathBuf},
    sync::atomic::{AtomicU32, Ordering},
};

use flate2::{Compression, write::GzEncoder};

use crate::motion::Row;

const COLUMNS: [&str; 14] = [
    "gx", "gy", "gz", "ax", "ay", "az", "mx", "my", "mz", "qw", "qx", "qy", "qz", "mov",
];

/// The files are removed when it is dropped.
pub struct Recording {
    folder: PathBuf,
    pub header: PathBuf,
}

impl Recording {
    pub fn write(name: &str, rows: &[Row]) -> anyhow::Result<Self> {
        static NUMBER: AtomicU32 = AtomicU32::new(0);
        let number = NUMBER.fetch_add(1, Ordering::Relaxed);
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("hits-{number}"));
        fs::create_dir_all(&folder)?;
        let header = folder.join(format!("{name}.json"));
        fs::write(&header, header_text(name, rows.len()))?;
        let data = fs::File::create(header.with_extension("f32.gz"))?;
        let mut data = GzEncoder::new(data, Compression::fast());
        data.write_all(&columns(rows))?;
        data.finish()?;
        Ok(Self { folder, header })
    }
}

impl Drop for Recording {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.folder);
    }
}

fn header_text(name: &str, rows: usize) -> String {
    let columns = COLUMNS.map(|column| format!("\"{column}\"")).join(", ");
    format!(
        r#"{{"trial": "{name}", "rows": {rows}, "rate_hz": 1000, "rate_num": 1000, "rate_den": 1, "columns": [{columns}]}}"#
    )
}

fn columns(rows: &[Row]) -> Vec<u8> {
    let values = |row: &Row| {
        let mut values = Vec::with_capacity(COLUMNS.len());
        values.extend(row.gyro_rps);
        values.extend(row.accel_mps2);
        values.extend(row.field_ut);
        values.extend(row.q_wxyz);
        values.push(1.0);
        values
    };
    let rows: Vec<Vec<f64>> = rows.iter().map(values).collect();
    (0..COLUMNS.len())
        .flat_map(|column| rows.iter().map(move |row| row[column] as f32))
        .flat_map(f32::to_le_bytes)
        .collect()
}
