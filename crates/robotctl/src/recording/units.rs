//! Finds the units of a table's columns, which the header names or the numbers show.

use super::sample::Sensor;
use crate::statistics::median;

const GRAVITY_MPS2: f64 = 9.806_65;
/// Fewest rows from which a unit is guessed.
const LEAST_ROWS: usize = 20;

/// The unit of a column cannot be guessed.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum UnitError {
    #[error(
        "most rows have the time of the row before: it must be finer, such as seconds with three decimals"
    )]
    TimeStandsStill,
    #[error(
        "its rows are {0} apart in time: in seconds that is not what a sensor gives (50 Hz or more, so 0.02 or less); if \
         it is another unit, name the column `t_ms` or `t_us`"
    )]
    UnlikelyPeriod(f64),
    #[error(
        "the acceleration is {0:.3} in the middle: at rest it is 9.8 in m/s² and 1 in g. Is it in another unit, or raw \
         counts?"
    )]
    UnlikelyGravity(f64),
}

/// The quantity in a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Quantity {
    Time,
    Of(Sensor),
}

impl Quantity {
    /// Returns the names of units, in lower case, with their factors into s, m/s² or µT.
    fn units(self) -> &'static [(&'static str, f64)] {
        match self {
            Self::Time => &[
                ("s", 1.0),
                ("sec", 1.0),
                ("seconds", 1.0),
                ("ms", 1e-3),
                ("us", 1e-6),
                ("µs", 1e-6),
                ("μs", 1e-6),
                ("ns", 1e-9),
            ],
            Self::Of(Sensor::Accelerometer) => &[
                ("m/s2", 1.0),
                ("m/s^2", 1.0),
                ("m/s²", 1.0),
                ("mps2", 1.0),
                ("g", GRAVITY_MPS2),
                ("mg", GRAVITY_MPS2 * 1e-3),
            ],
            Self::Of(Sensor::Magnetometer) => &[
                ("ut", 1.0),
                ("µt", 1.0),
                ("μt", 1.0),
                ("nt", 1e-3),
                ("t", 1e6),
                ("g", 100.0),
                ("gs", 100.0),
                ("gauss", 100.0),
                ("mg", 0.1),
                ("mgauss", 0.1),
            ],
        }
    }

    /// Returns the factor of a unit into the quantity's own.
    pub fn factor(self, unit: &str) -> Option<f64> {
        let mut units = self.units().iter();
        let found = units.find(|(name, _)| *name == unit);
        found.map(|(_, factor)| *factor)
    }
}

/// A unit guessed from the numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Guess {
    /// Factor into the quantity's own unit.
    pub factor: f64,
    /// Its name; `None` if it is the unit that this tool expects.
    pub taken_for: Option<&'static str>,
}

impl Guess {
    const AS_EXPECTED: Self = Self {
        factor: 1.0,
        taken_for: None,
    };

    const fn taken(factor: f64, unit: &'static str) -> Self {
        Self {
            factor,
            taken_for: Some(unit),
        }
    }
}

/// Guesses the unit of time. A recording for calibration has between 4 Hz and 3 kHz.
pub(super) fn of_time(times: &[f64]) -> Result<Guess, UnitError> {
    if times.len() < LEAST_ROWS {
        return Ok(Guess::AS_EXPECTED);
    }
    let steps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let step = median(steps);
    Ok(match step {
        0.000_3..=0.25 => Guess::AS_EXPECTED,
        2.0..=250.0 => Guess::taken(1e-3, "milliseconds"),
        400.0..=250_000.0 => Guess::taken(1e-6, "microseconds"),
        400_000.0..=250_000_000.0 => Guess::taken(1e-9, "nanoseconds"),
        0.0 => return Err(UnitError::TimeStandsStill),
        _ => return Err(UnitError::UnlikelyPeriod(step)),
    })
}

/// Guesses the unit of a sensor. An accelerometer that is mostly still shows gravity, and a magnetometer shows the
/// earth's field and some iron.
pub(super) fn of_vectors(sensor: Sensor, strengths: &[f64]) -> Result<Guess, UnitError> {
    if strengths.len() < LEAST_ROWS {
        return Ok(Guess::AS_EXPECTED);
    }
    let strength = median(strengths.to_vec());
    Ok(match (sensor, strength) {
        (Sensor::Accelerometer, 6.5..=13.5) => Guess::AS_EXPECTED,
        (Sensor::Accelerometer, 0.65..=1.35) => Guess::taken(GRAVITY_MPS2, "g"),
        (Sensor::Accelerometer, 650.0..=1_350.0) => Guess::taken(GRAVITY_MPS2 * 1e-3, "mg"),
        (Sensor::Accelerometer, _) => return Err(UnitError::UnlikelyGravity(strength)),
        (Sensor::Magnetometer, 0.02..2.0) => Guess::taken(100.0, "gauss"),
        (Sensor::Magnetometer, 5_000.0..200_000.0) => Guess::taken(1e-3, "nanotesla"),
        (Sensor::Magnetometer, _) => Guess::AS_EXPECTED,
    })
}
