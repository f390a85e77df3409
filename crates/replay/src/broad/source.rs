//! Reads a MATLAB file of the dataset.

use std::{fs::File, io, path::Path};

use matfile::{MatFile, NumericData};

/// Samples a second in every file of the dataset.
const RATE_HZ: f64 = 2_000.0 / 7.0;

/// A MATLAB file cannot be read, or does not belong to the dataset.
#[derive(Debug, thiserror::Error)]
pub enum SourceError {
    #[error(transparent)]
    Io(#[from] io::Error),
    #[error("it is no MATLAB file: {0}")]
    Format(String),
    #[error("it has no array `{0}` of the size that the dataset gives it")]
    Array(&'static str),
    #[error("it was sampled at {0} Hz instead of 285.7")]
    Rate(f64),
}

/// A recording with one row for each sample.
pub(super) struct Recorded {
    pub gyro_rps: Vec<[f64; 3]>,
    /// Specific force.
    pub accel_mps2: Vec<[f64; 3]>,
    pub field_ut: Vec<[f64; 3]>,
    /// Rotation from sensor to ENU earth, scalar first; NaN where the cameras lost the markers.
    pub reference_wxyz: Vec<[f64; 4]>,
    /// Position in ENU; NaN where the cameras lost the markers.
    pub position_m: Vec<[f64; 3]>,
    /// True in the phase that is scored.
    pub moving: Vec<bool>,
}

pub(super) fn read(path: &Path) -> Result<Recorded, SourceError> {
    let file = MatFile::parse(File::open(path)?)
        .map_err(|error| SourceError::Format(error.to_string()))?;
    let [rate] = rows::<1>(&file, "sampling_rate")?[..] else {
        return Err(SourceError::Array("sampling_rate"));
    };
    if (rate[0] - RATE_HZ).abs() > 1e-3 {
        return Err(SourceError::Rate(rate[0]));
    }
    let movement = rows::<1>(&file, "movement")?;
    let recorded = Recorded {
        gyro_rps: rows(&file, "imu_gyr")?,
        accel_mps2: rows(&file, "imu_acc")?,
        field_ut: rows(&file, "imu_mag")?,
        reference_wxyz: rows(&file, "opt_quat")?,
        position_m: rows(&file, "opt_pos")?,
        moving: movement.iter().map(|[flag]| *flag != 0.0).collect(),
    };
    for (name, length) in [
        ("imu_acc", recorded.accel_mps2.len()),
        ("imu_mag", recorded.field_ut.len()),
        ("opt_quat", recorded.reference_wxyz.len()),
        ("opt_pos", recorded.position_m.len()),
        ("movement", recorded.moving.len()),
    ] {
        if length != recorded.gyro_rps.len() || length == 0 {
            return Err(SourceError::Array(name));
        }
    }
    Ok(recorded)
}

/// Returns the rows of an array with `N` columns.
fn rows<const N: usize>(file: &MatFile, name: &'static str) -> Result<Vec<[f64; N]>, SourceError> {
    let wrong = || SourceError::Array(name);
    let array = file.find_by_name(name).ok_or_else(wrong)?;
    let values: Vec<f64> = match array.data() {
        NumericData::Double { real, .. } => real.clone(),
        NumericData::UInt8 { real, .. } => real.iter().copied().map(f64::from).collect(),
        _ => return Err(wrong()),
    };
    let [count, columns] = array.size()[..] else {
        return Err(wrong());
    };
    if columns != N || values.len() != count * columns {
        return Err(wrong());
    }
    // The array is stored column by column.
    let row = |row: usize| std::array::from_fn(|column| values[column * count + row]);
    Ok((0..count).map(row).collect())
}
