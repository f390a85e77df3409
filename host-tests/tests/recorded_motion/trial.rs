//! Reads the packed recordings.

use std::{
    fs::File,
    io::Read,
    path::{Path, PathBuf},
};

use anyhow::{Context, ensure};
use serde::Deserialize;

#[derive(Deserialize)]
struct Header {
    rows: usize,
    columns: Vec<String>,
}

/// One interval of 5 ms: means of the sensors over it, reference at its end.
pub struct Row {
    pub gyro_rps: [f32; 3],
    pub accel_mps2: [f32; 3],
    pub mag_ut: [f32; 3],
    /// NaN where the cameras lost the markers.
    reference_wxyz: [f32; 4],
    scored: bool,
}

pub struct Trial {
    pub name: String,
    pub rows: Vec<Row>,
}

impl Trial {
    /// The reference `share` of the way from row `index` to the next, inside the scored phase.
    pub fn scored_reference(&self, index: usize, share: f64) -> Option<[f64; 4]> {
        let from = self.rows.get(index)?;
        let a = from.reference_wxyz.map(f64::from);
        if share == 0.0 {
            return (from.scored && !a[0].is_nan()).then_some(a);
        }
        let mut b = self.rows.get(index + 1)?.reference_wxyz.map(f64::from);
        if (0..4).map(|i| a[i] * b[i]).sum::<f64>() < 0.0 {
            b = b.map(|part| -part);
        }
        let q: [f64; 4] = std::array::from_fn(|i| a[i] + share * (b[i] - a[i]));
        (from.scored && !q[0].is_nan()).then_some(q)
    }
}

/// All trials in the folder that `build.rs` found.
pub fn load_all() -> anyhow::Result<Vec<Trial>> {
    let folder = Path::new(env!("RECORDED_MOTION"));
    let mut headers: Vec<PathBuf> = std::fs::read_dir(folder)?
        .map(|entry| entry.map(|entry| entry.path()))
        .collect::<Result<_, _>>()?;
    headers.retain(|path| {
        path.extension()
            .is_some_and(|extension| extension == "json")
    });
    headers.sort();
    ensure!(!headers.is_empty(), "no trial in {}", folder.display());
    headers.iter().map(|path| load(path)).collect()
}

fn load(header_path: &Path) -> anyhow::Result<Trial> {
    let header: Header = serde_json::from_reader(File::open(header_path)?)?;
    let mut bytes = Vec::new();
    let packed = File::open(header_path.with_extension("f32.gz"))?;
    flate2::read::GzDecoder::new(packed).read_to_end(&mut bytes)?;
    ensure!(
        bytes.len() == header.rows * header.columns.len() * 4,
        "wrong length"
    );
    let values: Vec<f32> = bytes
        .chunks_exact(4)
        .map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]]))
        .collect();
    let column = |name: &str| -> anyhow::Result<&[f32]> {
        let index = header.columns.iter().position(|column| column == name);
        let index = index.with_context(|| format!("no column {name}"))?;
        Ok(&values[index * header.rows..(index + 1) * header.rows])
    };
    let names = [
        "gx", "gy", "gz", "ax", "ay", "az", "mx", "my", "mz", "qw", "qx", "qy", "qz", "mov",
    ];
    let columns = names.map(column);
    let mut data = Vec::new();
    for column in columns {
        data.push(column?);
    }
    let rows = (0..header.rows).map(|row| {
        let at = |column: usize| data[column][row];
        Row {
            gyro_rps: [at(0), at(1), at(2)],
            accel_mps2: [at(3), at(4), at(5)],
            mag_ut: [at(6), at(7), at(8)],
            reference_wxyz: [at(9), at(10), at(11), at(12)],
            scored: at(13) > 0.5,
        }
    });
    let name = header_path
        .file_stem()
        .unwrap_or_default()
        .to_string_lossy();
    Ok(Trial {
        name: name.into_owned(),
        rows: rows.collect(),
    })
}
