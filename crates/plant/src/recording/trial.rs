//! The file format of a recorded trial: a JSON header beside gzipped columns of 32-bit floats.

use std::{
    io::{self, Read},
    path::Path,
};

use serde::Deserialize;
use sha2::{Digest, Sha256};

use super::error::{TrialDefect, TrialError};
use crate::time::{Ps, SECOND};

#[derive(Deserialize)]
struct Header {
    rows: usize,
    columns: Vec<String>,
    rate_num: u64,
    rate_den: u64,
    #[serde(default)]
    sha256_raw: Option<String>,
}

impl Header {
    fn read(path: &Path) -> Result<Self, TrialDefect> {
        let header: Self = serde_json::from_str(&std::fs::read_to_string(path)?)?;
        if header.rows == 0 || header.rate_num == 0 {
            return Err(TrialDefect::Empty);
        }
        Ok(header)
    }

    fn row_period(&self) -> Ps {
        SECOND * self.rate_den / self.rate_num
    }
}

fn defect_of(path: &Path) -> impl Fn(TrialDefect) -> TrialError {
    move |defect| TrialError {
        path: path.to_owned(),
        defect,
    }
}

/// Time from the first row to the end of the last.
pub(super) fn duration(header_path: &Path) -> Result<Ps, TrialError> {
    let header = Header::read(header_path).map_err(defect_of(header_path))?;
    Ok(header.rows as Ps * header.row_period())
}

/// Compares the data with the header's checksum, where it names one.
fn check_sum(header: &Header, bytes: &[u8]) -> Result<(), TrialDefect> {
    let Some(expected) = &header.sha256_raw else {
        return Ok(());
    };
    let found: String = Sha256::digest(bytes)
        .iter()
        .map(|byte| format!("{byte:02x}"))
        .collect();
    if found != expected.to_lowercase() {
        return Err(TrialDefect::Checksum {
            found,
            expected: expected.clone(),
        });
    }
    Ok(())
}

/// The bytes of the columns beside the header.
fn unpack(header_path: &Path) -> Result<Vec<u8>, TrialDefect> {
    let path = header_path.with_extension("f32.gz");
    let read = || -> io::Result<Vec<u8>> {
        let mut bytes = Vec::new();
        flate2::read::GzDecoder::new(std::fs::File::open(&path)?).read_to_end(&mut bytes)?;
        Ok(bytes)
    };
    read().map_err(|source| TrialDefect::DataFile {
        file: path.clone(),
        source,
    })
}

/// Means over the interval that ends with the row, in the sensors' axes. A sensor that failed reads NaN.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// Angular rate, rad/s.
    pub gyro_rps: [f64; 3],
    /// Specific force, m/s²: +9.8 on the axis that points up at rest.
    pub accel_mps2: [f64; 3],
    /// Magnetic field, µT.
    pub field_ut: [f64; 3],
    /// Reference attitude, sensor → ENU earth, at the end of the interval, scalar first. NaN where the cameras lost the
    /// markers, and in a record without reference.
    pub reference_wxyz: [f64; 4],
    /// True in the movement phase, which is the part that counts for the score, and throughout a record that marks no phase.
    pub moving: bool,
}

/// A trial in memory. Row 0 ends at time 0.
#[derive(Clone)]
pub struct Trial {
    rows: Vec<Row>,
    row_period: Ps,
}

impl Trial {
    /// Reads `<trial>.json` and the `<trial>.f32.gz` beside it.
    ///
    /// # Errors
    /// A file is missing, or the two do not fit together by length or checksum.
    pub fn load(header_path: &Path) -> Result<Self, TrialError> {
        let load = || {
            let header = Header::read(header_path)?;
            Self::parse(&header, &unpack(header_path)?)
        };
        load().map_err(defect_of(header_path))
    }

    fn parse(header: &Header, bytes: &[u8]) -> Result<Self, TrialDefect> {
        let expected = header.rows * header.columns.len() * 4;
        if bytes.len() != expected {
            return Err(TrialDefect::Length {
                expected,
                found: bytes.len(),
                rate_num: header.rate_num,
                rate_den: header.rate_den,
            });
        }
        check_sum(header, bytes)?;
        let column = |name: &'static str| -> Result<Vec<f64>, TrialDefect> {
            let index = header
                .columns
                .iter()
                .position(|column| column == name)
                .ok_or(TrialDefect::MissingColumn(name))?;
            let bytes = &bytes[index * header.rows * 4..(index + 1) * header.rows * 4];
            Ok(bytes
                .chunks_exact(4)
                .map(|b| f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]])))
                .collect())
        };
        let gyro = [column("gx")?, column("gy")?, column("gz")?];
        let accel = [column("ax")?, column("ay")?, column("az")?];
        let field = [column("mx")?, column("my")?, column("mz")?];
        let known = |name: &str| header.columns.iter().any(|column| column == name);
        let column_or = |name: &'static str, otherwise: f64| match known(name) {
            true => column(name),
            false => Ok(vec![otherwise; header.rows]),
        };
        let [w, x, y, z] = ["qw", "qx", "qy", "qz"].map(|part| column_or(part, f64::NAN));
        let reference = [w?, x?, y?, z?];
        let moving = column_or("mov", 1.0)?;
        let rows = (0..header.rows)
            .map(|row| Row {
                gyro_rps: std::array::from_fn(|axis| gyro[axis][row]),
                accel_mps2: std::array::from_fn(|axis| accel[axis][row]),
                field_ut: std::array::from_fn(|axis| field[axis][row]),
                reference_wxyz: std::array::from_fn(|part| reference[part][row]),
                moving: moving[row] > 0.5,
            })
            .collect();
        Ok(Self {
            rows,
            row_period: header.row_period(),
        })
    }

    /// Index of the row in force this long after row 0; after the end, that of the last row.
    pub(super) fn index_at(&self, since: Ps) -> usize {
        ((since / self.row_period) as usize).min(self.rows.len() - 1)
    }

    /// Index of the row whose interval contains the instant this long after row 0 ended, or ends with it; after the end, that
    /// of the last row.
    pub(super) fn index_ending_after(&self, since: Ps) -> usize {
        (since.div_ceil(self.row_period) as usize).min(self.rows.len() - 1)
    }

    /// Replaces the values of a sensor that failed by its last ones, or by the next ones before its first.
    pub(super) fn bridge_failures(&mut self) {
        let columns: [fn(&mut Row) -> &mut [f64; 3]; 3] = [
            |row| &mut row.gyro_rps,
            |row| &mut row.accel_mps2,
            |row| &mut row.field_ut,
        ];
        for column in columns {
            let is_number = |value: &[f64; 3]| value.iter().all(|axis| axis.is_finite());
            let first = self.rows.iter_mut().map(column).find(|v| is_number(v));
            let mut last = first.copied().unwrap_or_default();
            for value in self.rows.iter_mut().map(column) {
                if is_number(value) {
                    last = *value;
                } else {
                    *value = last;
                }
            }
        }
    }

    /// Index of a row and share of the way to the next; `None` after the end.
    pub(super) fn position_at(&self, since: Ps) -> Option<(usize, f64)> {
        let index = (since / self.row_period) as usize;
        let share = (since % self.row_period) as f64 / self.row_period as f64;
        (index + 1 < self.rows.len()).then_some((index, share))
    }

    pub(super) fn row(&self, index: usize) -> Row {
        self.rows[index]
    }

    /// All rows, in the order of time.
    pub fn rows(&self) -> &[Row] {
        &self.rows
    }

    /// The time that one row covers.
    pub fn row_period(&self) -> Ps {
        self.row_period
    }
}
