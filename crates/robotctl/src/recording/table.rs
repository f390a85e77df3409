//! Reads tables of values under a header line that names the columns: time and three axes. Other columns are ignored,
//! as are empty lines, lines that start with `#`, and rows that have no value of the sensor.
//!
//! | what | may be |
//! |---|---|
//! | separator | comma, semicolon, tab |
//! | decimals | point; comma where it does not separate |
//! | names | `t`, `time`, `timestamp`; `ax`, `acc_x`, `accel_x`; `mx`, `mag_x`; in upper or lower case |
//! | units | s, m/s², µT; any other if the header names it (`t_ms`, `ax [g]`) or the numbers leave no doubt |

use nalgebra::Vector3;

use super::{
    header::{Columns, Header, HeaderError},
    sample::{Sample, Sensor},
    units::{self, UnitError},
};

/// A line of a table cannot be read.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RowError {
    #[error("this is no text in UTF-8")]
    NotUtf8,
    #[error(transparent)]
    Header(#[from] HeaderError),
    #[error(transparent)]
    Unit(#[from] UnitError),
    #[error("some of the three axes have a unit in the header and some have none")]
    MixedUnits,
    #[error("column {column}: `{field}` is no number")]
    NoNumber { column: usize, field: String },
    #[error("time runs backwards: one recording a file")]
    TimeRunsBackwards,
}

#[derive(Debug, PartialEq)]
pub(super) struct TableError {
    /// Number of the line, counted from 1.
    pub line: usize,
    pub why: RowError,
}

/// The samples of a table, in s and the sensor's unit, and notes about guessed units.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Table {
    pub samples: Vec<Sample>,
    pub notes: Vec<String>,
}

pub(super) fn read(bytes: &[u8], sensor: Sensor) -> Result<Table, TableError> {
    let text = std::str::from_utf8(bytes).map_err(|_| TableError {
        line: 1,
        why: RowError::NotUtf8,
    })?;
    let mut lines = text
        .trim_start_matches('\u{feff}')
        .lines()
        .enumerate()
        .map(|(index, line)| (index + 1, line.trim_end_matches('\r')))
        .filter(|(_, line)| !line.trim().is_empty() && !line.trim_start().starts_with('#'));
    let Some((header_line, header)) = lines.next() else {
        return Ok(Table::default());
    };
    let of_header = |why| TableError {
        line: header_line,
        why,
    };
    let header = Header::parse(header, sensor).map_err(|why| of_header(why.into()))?;
    let mut samples: Vec<Sample> = Vec::new();
    for (line, row) in lines {
        let sample = sample(&header, row).map_err(|why| TableError { line, why })?;
        let Some(sample) = sample else {
            continue;
        };
        if samples.last().is_some_and(|last| last.t_s > sample.t_s) {
            let why = RowError::TimeRunsBackwards;
            return Err(TableError { line, why });
        }
        samples.push(sample);
    }
    let notes = convert(&mut samples, &header.columns, sensor).map_err(of_header)?;
    Ok(Table { samples, notes })
}

/// Parses a row. It returns `None` if the row has no value of the sensor.
fn sample(header: &Header, row: &str) -> Result<Option<Sample>, RowError> {
    let fields = header.fields(row)?;
    let field = |place: usize| fields.get(place).copied().unwrap_or_default();
    let axes = header.columns.axes.map(|axis| axis.place);
    if axes.iter().all(|place| field(*place).is_empty()) && fields.len() > axes[0] {
        return Ok(None);
    }
    let number = |place: usize| {
        let field = field(place);
        match header.number(field) {
            Some(number) if number.is_finite() => Ok(number),
            _ => Err(RowError::NoNumber {
                column: place + 1,
                field: field.to_owned(),
            }),
        }
    };
    let [x, y, z] = axes;
    Ok(Some(Sample {
        t_s: number(header.columns.time.place)?,
        value: Vector3::new(number(x)?, number(y)?, number(z)?),
    }))
}

/// Converts samples into s and the sensor's unit, and returns notes about guessed units.
fn convert(
    samples: &mut [Sample],
    columns: &Columns,
    sensor: Sensor,
) -> Result<Vec<String>, RowError> {
    let mut notes = Vec::new();
    let time_factor = match columns.time.factor {
        Some(factor) => factor,
        None => {
            let times: Vec<f64> = samples.iter().map(|sample| sample.t_s).collect();
            let guess = units::of_time(&times)?;
            notes.extend(guess.taken_for.map(|unit| format!("time is in {unit}")));
            guess.factor
        }
    };
    let [x, y, z] = columns.axes.map(|axis| axis.factor);
    let factors = match (x, y, z) {
        (Some(x), Some(y), Some(z)) => Vector3::new(x, y, z),
        (None, None, None) => {
            let strengths: Vec<f64> = samples.iter().map(|sample| sample.value.norm()).collect();
            let guess = units::of_vectors(sensor, &strengths)?;
            notes.extend(guess.taken_for.map(|unit| format!("values are in {unit}")));
            Vector3::repeat(guess.factor)
        }
        _ => {
            return Err(RowError::MixedUnits);
        }
    };
    for sample in samples {
        sample.t_s *= time_factor;
        sample.value.component_mul_assign(&factors);
    }
    Ok(notes)
}

#[cfg(test)]
mod tests;
