//! Words and numbers of a status, line by line.

use std::fmt::{self, Formatter};

use robot_app::tuning::LiveValue;

use crate::tuning::LiveReading;

/// Mark of a joint's motor that reports it is enabled. It says nothing of the torque commanded.
pub const REPORTS_ENABLED: &str = "gives-torque";

pub fn list(
    f: &mut Formatter<'_>,
    names: &[String],
    advice: fn(&str) -> Option<&'static str>,
) -> fmt::Result {
    for name in names {
        let advice = advice(name).unwrap_or_default();
        let line = format!("  {name:<22} {advice}");
        writeln!(f, "{}", line.trim_end())?;
    }
    Ok(())
}

/// Lists all fields of the page without words of their own.
pub fn rest(f: &mut Formatter<'_>, reading: &LiveReading) -> fmt::Result {
    for (field, value) in reading.values() {
        match value {
            LiveValue::Count(count) => write!(f, ", {field} {count}")?,
            LiveValue::Measure(Some(measured)) => write!(f, ", {field} {measured}")?,
            LiveValue::Measure(None) => write!(f, ", {field} unknown")?,
            LiveValue::Choice(_) => write!(f, ", {field} {}", reading.choice(field))?,
            LiveValue::Set(0) => {}
            LiveValue::Set(_) => write!(f, ", {}", reading.set(field).join(", "))?,
        }
    }
    Ok(())
}

pub fn marks(f: &mut Formatter<'_>, reading: &LiveReading) -> fmt::Result {
    let marks = reading.set("marks");
    for mark in marks.iter().filter(|mark| *mark != REPORTS_ENABLED) {
        write!(f, ", {}", mark.to_uppercase())?;
    }
    writeln!(f)
}

pub fn whole(reading: &LiveReading, field: &str) -> u32 {
    reading.number(field).unwrap_or_default() as u32
}

pub fn number(value: Option<f64>, digits: usize) -> String {
    value.map_or("?".to_owned(), |value| format!("{value:.digits$}"))
}

pub fn duration(seconds: Option<f64>) -> String {
    let seconds = seconds.unwrap_or_default() as u64;
    let (hours, minutes) = (seconds / 3_600, seconds / 60 % 60);
    format!("{hours}:{minutes:02}:{:02} h", seconds % 60)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hours_are_shown_as_such() {
        assert_eq!(duration(Some(3_661.0)), "1:01:01 h");
    }
}
