//! Measured values and the verdict on them.

use crate::tuning::{LiveReading, TuningClient, TuningError, live_page};

/// The verdict on a check.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Verdict {
    #[default]
    AsItMustBe,
    Wrong(String),
    /// Only the user can judge it.
    ForTheUser,
}

/// Values with their names, and the verdict on them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Measured {
    pub values: Vec<(String, f64)>,
    pub words: Vec<(String, String)>,
    pub verdict: Verdict,
}

impl Measured {
    /// Records a number and returns it: NaN if the robot does not know it.
    pub fn value(&mut self, reading: &LiveReading, field: &str) -> f64 {
        let value = reading.number(field).unwrap_or(f64::NAN);
        self.values.push((field.to_owned(), value));
        value
    }

    pub fn word(&mut self, name: &str, word: String) {
        self.words.push((name.to_owned(), word));
    }

    /// Makes the verdict `Wrong` unless it `holds`. The first failure is kept.
    pub fn must(&mut self, holds: bool, otherwise: impl FnOnce() -> String) {
        if !holds && self.verdict == Verdict::AsItMustBe {
            self.verdict = Verdict::Wrong(otherwise());
        }
    }
}

/// A function that measures what a check is about.
pub type MeasureFn = fn(&mut TuningClient) -> Result<Measured, TuningError>;

/// Reads a page of one part, 0 for a page about the whole robot.
pub fn read(
    client: &mut TuningClient,
    page: &str,
    part: usize,
) -> Result<LiveReading, TuningError> {
    client
        .live(live_page(page), part)?
        .ok_or(TuningError::TooOld)
}

pub const AXES: [&str; 3] = ["x", "y", "z"];

/// Records the three axes of a page.
pub fn vector(
    found: &mut Measured,
    client: &mut TuningClient,
    page: &str,
    unit: &str,
) -> Result<[f64; 3], TuningError> {
    let reading = read(client, page, 0)?;
    Ok(AXES.map(|axis| found.value(&reading, &format!("{axis}-{unit}"))))
}
