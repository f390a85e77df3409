//! The record's file format: a JSON header beside gzipped columns of 32-bit floats (BROAD trials, `README.md` there).

use std::{io::Read, path::Path};

use serde::Deserialize;

use crate::{
    attitude::Quaternion,
    time::{Ps, SECOND},
    world::WorldError,
};

#[derive(Deserialize)]
struct Header {
    rows: usize,
    columns: Vec<String>,
    rate_num: u64,
    rate_den: u64,
}

impl Header {
    fn read(path: &Path) -> Result<Self, WorldError> {
        let text = std::fs::read_to_string(path).map_err(|e| wrong(path, e.to_string()))?;
        let header: Self = serde_json::from_str(&text).map_err(|e| wrong(path, e.to_string()))?;
        if header.rows == 0 || header.rate_num == 0 {
            return Err(wrong(path, "no rows, or no rate".into()));
        }
        Ok(header)
    }

    fn row_period(&self) -> Ps {
        SECOND * self.rate_den / self.rate_num
    }
}

fn wrong(path: &Path, why: String) -> WorldError {
    WorldError::Trial {
        path: path.to_owned(),
        why,
    }
}

/// Time from the first row to the end of the last.
pub(super) fn duration(header_path: &Path) -> Result<Ps, WorldError> {
    let header = Header::read(header_path)?;
    Ok(header.rows as Ps * header.row_period())
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Row {
    pub gyro_rps: [f64; 3],
    /// Specific force.
    pub accel_mps2: [f64; 3],
    pub field_ut: [f64; 3],
    /// Not numbers where the cameras lost the markers.
    pub reference: Quaternion,
    pub moving: bool,
}

pub(super) struct Trial {
    rows: Vec<Row>,
    row_period: Ps,
}

impl Trial {
    /// Reads `<trial>.json` and the `<trial>.f32.gz` beside it.
    pub(super) fn load(header_path: &Path) -> Result<Self, WorldError> {
        let header = Header::read(header_path)?;
        let fail = |why: String| wrong(header_path, why);
        let data_path = header_path.with_extension("f32.gz");
        let file = std::fs::File::open(&data_path)
            .map_err(|error| fail(format!("{}: {error}", data_path.display())))?;
        let mut bytes = Vec::new();
        flate2::read::GzDecoder::new(file)
            .read_to_end(&mut bytes)
            .map_err(|error| fail(format!("{}: {error}", data_path.display())))?;
        Self::parse(&header, &bytes).map_err(fail)
    }

    fn parse(header: &Header, bytes: &[u8]) -> Result<Self, String> {
        let expected = header.rows * header.columns.len() * 4;
        if bytes.len() != expected {
            return Err(format!(
                "header speaks of {expected} bytes at {}/{} Hz, data has {}",
                header.rate_num,
                header.rate_den,
                bytes.len()
            ));
        }
        let column = |name: &str| -> Result<Vec<f64>, String> {
            let index = header
                .columns
                .iter()
                .position(|column| column == name)
                .ok_or_else(|| format!("no column `{name}`"))?;
            let bytes = &bytes[index * header.rows * 4..(index + 1) * header.rows * 4];
            Ok(bytes
                .chunks_exact(4)
                .map(|b| f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]])))
                .collect())
        };
        let gyro = [column("gx")?, column("gy")?, column("gz")?];
        let accel = [column("ax")?, column("ay")?, column("az")?];
        let field = [column("mx")?, column("my")?, column("mz")?];
        let reference = [column("qw")?, column("qx")?, column("qy")?, column("qz")?];
        let moving = column("mov")?;
        let rows = (0..header.rows)
            .map(|row| Row {
                gyro_rps: std::array::from_fn(|axis| gyro[axis][row]),
                accel_mps2: std::array::from_fn(|axis| accel[axis][row]),
                field_ut: std::array::from_fn(|axis| field[axis][row]),
                reference: std::array::from_fn(|part| reference[part][row]),
                moving: moving[row] > 0.5,
            })
            .collect();
        Ok(Self {
            rows,
            row_period: header.row_period(),
        })
    }

    /// Row in force this long after row 0; the last one after the end.
    pub(super) fn index_at(&self, since: Ps) -> usize {
        ((since / self.row_period) as usize).min(self.rows.len() - 1)
    }

    /// Row and share of the way to the next; `None` past the end.
    pub(super) fn position_at(&self, since: Ps) -> Option<(usize, f64)> {
        let index = (since / self.row_period) as usize;
        let share = (since % self.row_period) as f64 / self.row_period as f64;
        (index + 1 < self.rows.len()).then_some((index, share))
    }

    pub(super) fn row(&self, index: usize) -> Row {
        self.rows[index]
    }
}
