//! Writes trials of a motion known in closed form, in the format of the recordings.

use std::{
    fs,
    io::Write,
    path::{Path, PathBuf},
};

use flate2::{Compression, write::GzEncoder};
use serde_json::json;

pub const COLUMNS: [&str; 15] = [
    "t", "gx", "gy", "gz", "ax", "ay", "az", "mx", "my", "mz", "qw", "qx", "qy", "qz", "mov",
];

/// Returns an empty folder for one test.
pub fn folder(test: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(test);
    fs::remove_dir_all(&folder).ok();
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// Rows per second, as a fraction.
#[derive(Clone, Copy)]
pub struct Rate {
    pub num: u64,
    pub den: u64,
}

pub const HZ200: Rate = Rate { num: 200, den: 1 };
/// A row lasts 3.5 ms.
pub const NATIVE: Rate = Rate { num: 2000, den: 7 };

/// A level sensor that rests for 10 s and then turns to the left at a constant rate.
pub struct Turn {
    pub rate_dps: f64,
    /// The reference's heading exceeds the true one by this.
    pub reference_off_deg: f64,
}

const REST_S: f64 = 10.0;
const LENGTH_S: f64 = 40.0;
const FIELD_NORTH_UT: f64 = 20.0;
const FIELD_UP_UT: f64 = -45.0;

impl Turn {
    fn heading_rad(&self, t_s: f64) -> f64 {
        self.rate_dps.to_radians() * (t_s - REST_S).max(0.0)
    }

    /// Returns the means over `from..to`. The rate of the turn has one step. The level field of a body at heading ψ is
    /// (sin ψ, cos ψ), whose integral is (−cos ψ, sin ψ) / ω.
    fn row(&self, from: f64, to: f64) -> [f64; 15] {
        let (psi0, psi1) = (self.heading_rad(from), self.heading_rad(to));
        let gyro_z = (psi1 - psi0) / (to - from);
        let turned = psi1 - psi0;
        let (east, north) = if turned == 0.0 {
            (psi1.sin(), psi1.cos())
        } else {
            (
                (psi0.cos() - psi1.cos()) / turned,
                (psi1.sin() - psi0.sin()) / turned,
            )
        };
        let said = psi1 + self.reference_off_deg.to_radians();
        [
            to,
            0.0,
            0.0,
            gyro_z,
            0.0,
            0.0,
            9.81,
            FIELD_NORTH_UT * east,
            FIELD_NORTH_UT * north,
            FIELD_UP_UT,
            (said / 2.0).cos(),
            0.0,
            0.0,
            (said / 2.0).sin(),
            f64::from(to > REST_S),
        ]
    }

    /// Returns the columns of the whole trial.
    pub fn columns(&self, rate: Rate) -> Vec<Vec<f32>> {
        let period = rate.den as f64 / rate.num as f64;
        let count = (LENGTH_S / period) as usize;
        let rows = (0..count).map(|i| self.row((i as f64 - 1.0) * period, i as f64 * period));
        let rows: Vec<[f64; 15]> = rows.collect();
        (0..15)
            .map(|c| rows.iter().map(|row| row[c] as f32).collect())
            .collect()
    }
}

/// Writes `<name>.json` and `<name>.f32.gz`; returns the header's path.
pub fn write(folder: &Path, name: &str, rate: Rate, columns: &[Vec<f32>]) -> PathBuf {
    let rows = columns[0].len();
    let bytes: Vec<u8> = columns
        .iter()
        .flatten()
        .flat_map(|v| v.to_le_bytes())
        .collect();
    let header = json!({
        "rows": rows,
        "columns": COLUMNS[..columns.len()],
        "rate_num": rate.num,
        "rate_den": rate.den,
    });
    let path = folder.join(format!("{name}.json"));
    fs::write(&path, header.to_string()).unwrap();
    let mut gzip = GzEncoder::new(Vec::new(), Compression::fast());
    gzip.write_all(&bytes).unwrap();
    fs::write(path.with_extension("f32.gz"), gzip.finish().unwrap()).unwrap();
    path
}
