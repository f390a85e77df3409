//! Comma-separated values under a header line that names the columns: `t` in seconds and three axes. Other columns are
//! ignored, as are empty lines and lines that start with `#`.

use nalgebra::Vector3;

use super::{Sample, Sensor};

#[derive(Debug, PartialEq)]
pub(super) struct TableError {
    /// Counted from 1.
    pub line: usize,
    pub why: String,
}

pub(super) fn samples(bytes: &[u8], sensor: Sensor) -> Result<Vec<Sample>, TableError> {
    let text = std::str::from_utf8(bytes).map_err(|_| TableError {
        line: 1,
        why: "this is no text".into(),
    })?;
    let mut lines = text
        .lines()
        .enumerate()
        .map(|(index, line)| (index + 1, line.trim().trim_start_matches('\u{feff}')))
        .filter(|(_, line)| !line.is_empty() && !line.starts_with('#'));
    let Some((line, header)) = lines.next() else {
        return Ok(Vec::new());
    };
    let columns = Columns::find(header, sensor).map_err(|why| TableError { line, why })?;
    let mut samples: Vec<Sample> = Vec::new();
    for (line, row) in lines {
        let sample = columns.read(row).map_err(|why| TableError { line, why })?;
        if samples.last().is_some_and(|last| last.t_s > sample.t_s) {
            let why = "time runs backwards: one recording a file".into();
            return Err(TableError { line, why });
        }
        samples.push(sample);
    }
    Ok(samples)
}

/// Places of the columns in a row.
struct Columns {
    time: usize,
    axes: [usize; 3],
}

impl Columns {
    fn find(header: &str, sensor: Sensor) -> Result<Self, String> {
        let names: Vec<&str> = header.split(',').map(str::trim).collect();
        let place = |name: &str| {
            names.iter().position(|n| *n == name).ok_or_else(|| {
                let [x, y, z] = sensor.columns();
                format!("no column `{name}`; the header must be `t,{x},{y},{z}`")
            })
        };
        let [x, y, z] = sensor.columns();
        Ok(Self {
            time: place("t")?,
            axes: [place(x)?, place(y)?, place(z)?],
        })
    }

    fn read(&self, row: &str) -> Result<Sample, String> {
        let fields: Vec<&str> = row.split(',').map(str::trim).collect();
        let number = |place: usize| {
            let field = fields.get(place).copied().unwrap_or_default();
            match field.parse::<f64>() {
                Ok(number) if number.is_finite() => Ok(number),
                _ => Err(format!("column {}: `{field}` is no number", place + 1)),
            }
        };
        let [x, y, z] = self.axes;
        Ok(Sample {
            t_s: number(self.time)?,
            value: Vector3::new(number(x)?, number(y)?, number(z)?),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_found_by_name_in_any_order() {
        let text = "# board 7\nmy, t ,mx,gap,mz\n\n2,0.5,1,9,-3e1\n";
        let samples = samples(text.as_bytes(), Sensor::Magnetometer).unwrap();
        let value = Vector3::new(1.0, 2.0, -30.0);
        assert_eq!(samples, [Sample { t_s: 0.5, value }]);
    }

    #[test]
    fn a_wrong_line_is_named() {
        let error = |text: &str| {
            let error = samples(text.as_bytes(), Sensor::Accelerometer).unwrap_err();
            (error.line, error.why)
        };
        let (line, why) = error("t,ax,ay\n");
        assert_eq!(line, 1);
        assert!(why.contains("`az`") && why.contains("t,ax,ay,az"), "{why}");
        assert_eq!(error("t,ax,ay,az\n0,1,2,3\n1,2,nan,4\n").0, 3);
        assert_eq!(error("t,ax,ay,az\n0,1,2\n").0, 2);
        assert_eq!(error("t,ax,ay,az\n1,0,0,9\n0.5,0,0,9\n").0, 3);
    }
}
