//! Parses the first line of a table: its separator, and the columns that are read.

use super::{sample::Sensor, units::Quantity};

/// The header of a table, or a row under it, cannot be read.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum HeaderError {
    #[error(
        "`{line}` has one column only: separate columns with commas, semicolons or tabs; {}",
        .sensor.expected_header()
    )]
    OneColumn { line: String, sensor: Sensor },
    #[error("a line of numbers stands where the columns' names must be; {}", .0.expected_header())]
    NoNames(Sensor),
    #[error("no column `{name}` among {names}; {}", .sensor.expected_header())]
    NoColumn {
        name: String,
        names: String,
        sensor: Sensor,
    },
    #[error("the unit `{unit}` of column `{name}` is not known")]
    UnknownUnit { unit: String, name: String },
    #[error(
        "{fields} fields under {names} names: are these decimal commas between commas? Export with semicolons or with \
         decimal points"
    )]
    DecimalCommas { fields: usize, names: usize },
}

/// A column that is read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Column {
    pub place: usize,
    /// Factor into s, m/s² or µT; `None` if the header names no unit.
    pub factor: Option<f64>,
}

#[derive(Clone, Debug)]
pub(super) struct Columns {
    pub time: Column,
    pub axes: [Column; 3],
}

#[derive(Clone, Debug)]
pub(super) struct Header {
    separator: char,
    width: usize,
    pub columns: Columns,
}

impl Header {
    pub fn parse(line: &str, sensor: Sensor) -> Result<Self, HeaderError> {
        let count = |separator: &char| line.matches(*separator).count();
        // This is the most frequent separator, or the first of several.
        let separator = [',', ';', '\t'].into_iter().rev().max_by_key(count);
        let separator = separator.filter(|separator| count(separator) > 0);
        let Some(separator) = separator else {
            let line = line.to_owned();
            return Err(HeaderError::OneColumn { line, sensor });
        };
        let names: Vec<&str> = split(line, separator);
        if names.iter().all(|name| is_number(name)) {
            return Err(HeaderError::NoNames(sensor));
        }
        let [x, y, z] = ["x", "y", "z"].map(|axis| axis_column(&names, sensor, axis));
        Ok(Self {
            separator,
            width: names.len(),
            columns: Columns {
                time: time_column(&names, sensor)?,
                axes: [x?, y?, z?],
            },
        })
    }

    /// Splits a row.
    pub fn fields<'a>(&self, row: &'a str) -> Result<Vec<&'a str>, HeaderError> {
        let fields = split(row, self.separator);
        if self.separator == ',' && self.width > 1 && fields.len() == 2 * self.width {
            return Err(HeaderError::DecimalCommas {
                fields: fields.len(),
                names: self.width,
            });
        }
        Ok(fields)
    }

    /// Parses a number. Its decimal point may be a comma where commas do not separate columns.
    pub fn number(&self, field: &str) -> Option<f64> {
        match field.matches(',').count() {
            1 if self.separator != ',' && !field.contains('.') => field.replace(',', ".").parse(),
            _ => field.parse(),
        }
        .ok()
    }
}

fn split(line: &str, separator: char) -> Vec<&str> {
    let fields = line.split(separator);
    fields
        .map(|field| field.trim().trim_matches('"').trim())
        .collect()
}

fn is_number(text: &str) -> bool {
    text.replace(',', ".").parse::<f64>().is_ok()
}

fn time_column(names: &[&str], sensor: Sensor) -> Result<Column, HeaderError> {
    const NAMES: [&str; 3] = ["t", "time", "timestamp"];
    column(names, Quantity::Time, |name| NAMES.contains(&name))?
        .ok_or_else(|| missing("t", names, sensor))
}

fn axis_column(names: &[&str], sensor: Sensor, axis: &str) -> Result<Column, HeaderError> {
    let begins: &[&str] = match sensor {
        Sensor::Accelerometer => &["a", "acc", "accel"],
        Sensor::Magnetometer => &["m", "mag"],
    };
    let is_wanted = |name: &str| begins.iter().any(|begin| name == format!("{begin}{axis}"));
    column(names, Quantity::Of(sensor), is_wanted)?
        .ok_or_else(|| missing(&format!("{}{axis}", begins[0]), names, sensor))
}

fn missing(name: &str, names: &[&str], sensor: Sensor) -> HeaderError {
    HeaderError::NoColumn {
        name: name.to_owned(),
        names: names.join(", "),
        sensor,
    }
}

fn column(
    names: &[&str],
    quantity: Quantity,
    is_wanted: impl Fn(&str) -> bool,
) -> Result<Option<Column>, HeaderError> {
    for (place, name) in names.iter().enumerate() {
        let (name, unit) = name_and_unit(name, quantity);
        if !is_wanted(&name) {
            continue;
        }
        let factor = match unit {
            None => None,
            Some(unit) => match quantity.factor(&unit) {
                Some(factor) => Some(factor),
                None => return Err(HeaderError::UnknownUnit { unit, name }),
            },
        };
        return Ok(Some(Column { place, factor }));
    }
    Ok(None)
}

/// Splits `ax`, `Acc_X`, `t_ms`, `ax [g]` or `time (s)` into the name, in lower case without `_`, and the unit if there
/// is one.
fn name_and_unit(text: &str, quantity: Quantity) -> (String, Option<String>) {
    let text = text.to_lowercase();
    let bare = |name: &str| name.replace(['_', ' ', '.'], "");
    if let Some((name, unit)) = text.split_once(['[', '(']) {
        let unit = unit.trim_end_matches([']', ')']).trim().to_owned();
        return (bare(name), Some(unit));
    }
    match text.rsplit_once(['_', ' ']) {
        Some((name, unit)) if quantity.factor(unit).is_some() => {
            (bare(name), Some(unit.to_owned()))
        }
        _ => (bare(&text), None),
    }
}
