//! Conditions on signals that must hold in a run. They are judged sample by sample while it runs.

use robot_plant::time::{self, Ps};

use crate::machine::diagnostics::meaning::Meaning;

#[derive(Clone, Debug)]
pub struct Expectation {
    pub signal: String,
    pub window: Window,
    /// Bounds and flags that must all hold. There is at least one of either.
    pub bounds: Vec<Bound>,
    /// Flags of the signal, named as in the image.
    pub flags: Vec<NamedFlag>,
    /// The reason for the expectation, shown in the report.
    pub because: Option<String>,
}

/// A named flag cannot be judged.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FlagError {
    #[error("the image names no flags of `{0}`; write `has_bit` or `lacks_bit`")]
    NoNames(String),
    #[error("`{signal}` has no flag `{flag}`; it has {known}")]
    Unknown {
        signal: String,
        flag: String,
        known: String,
    },
}

/// A flag that must be set, or clear, throughout.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NamedFlag {
    pub name: String,
    pub set: bool,
}

impl NamedFlag {
    /// The bound on the signal whose values have this `meaning`, or an error that says why there is none.
    pub fn bound(&self, signal: &str, meaning: Option<&Meaning>) -> Result<Bound, FlagError> {
        let Some(Meaning::Flags(names)) = meaning else {
            return Err(FlagError::NoNames(signal.to_owned()));
        };
        match names.iter().find(|(_, name)| **name == self.name) {
            Some((bit, _)) if self.set => Ok(Bound::HasBit(*bit)),
            Some((bit, _)) => Ok(Bound::LacksBit(*bit)),
            None => {
                let known: Vec<&str> = names.values().map(String::as_str).collect();
                Err(FlagError::Unknown {
                    signal: signal.to_owned(),
                    flag: self.name.clone(),
                    known: known.join(", "),
                })
            }
        }
    }
}

impl std::fmt::Display for NamedFlag {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let verb = if self.set { "has" } else { "lacks" };
        write!(f, "{verb} flag {}", self.name)
    }
}

/// A window in time. Both ends belong to it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    pub start: Ps,
    pub end: Ps,
}

impl Window {
    /// A single instant. It is judged at the first sample at or after it.
    pub fn instant(at: Ps) -> Self {
        Self { start: at, end: at }
    }

    fn is_instant(self) -> bool {
        self.start == self.end
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bound {
    MaxAbs(f64),
    Min(f64),
    Max(f64),
    Equals(f64),
    Within {
        value: f64,
        tolerance: f64,
    },
    /// Bit `n` of the signal, a set of flags, is set throughout.
    HasBit(u8),
    /// Bit `n` of the signal, a set of flags, is clear throughout.
    LacksBit(u8),
    /// At some instant of the window the signal goes from at or below this to above it.
    RisesAbove(f64),
    /// At some instant of the window the signal goes from at or above this to below it.
    FallsBelow(f64),
}

impl Bound {
    pub fn is_usable(self) -> bool {
        match self {
            Self::MaxAbs(v) => v.is_finite() && v >= 0.0,
            Self::Within { value, tolerance } => {
                value.is_finite() && tolerance.is_finite() && tolerance >= 0.0
            }
            Self::Min(v) | Self::Max(v) | Self::Equals(v) => v.is_finite(),
            Self::RisesAbove(v) | Self::FallsBelow(v) => v.is_finite(),
            Self::HasBit(n) | Self::LacksBit(n) => n < 32,
        }
    }

    /// Amount by which `value` exceeds this bound: 0 if it holds, infinite for NaN.
    fn excess(self, value: f64) -> f64 {
        let excess = match self {
            Self::MaxAbs(limit) => value.abs() - limit,
            Self::Min(limit) => limit - value,
            Self::Max(limit) => value - limit,
            Self::Equals(wanted) => (value - wanted).abs(),
            Self::Within {
                value: wanted,
                tolerance,
            } => (value - wanted).abs() - tolerance,
            Self::HasBit(n) => f64::from(!has_bit(value, n)),
            Self::LacksBit(n) => f64::from(has_bit(value, n)),
            Self::RisesAbove(_) | Self::FallsBelow(_) => 0.0,
        };
        if value.is_nan() {
            f64::INFINITY
        } else {
            excess.max(0.0)
        }
    }

    /// The text of `Display`, with the firmware's name of the state or flag.
    fn in_words(self, meaning: Option<&Meaning>) -> String {
        let words = meaning.and_then(|meaning| match self {
            Self::Equals(value) => meaning.words(value),
            Self::HasBit(bit) | Self::LacksBit(bit) => meaning.bit(bit).map(str::to_owned),
            _ => None,
        });
        format!("{self}{}", in_brackets(words))
    }

    fn crossed(self, before: f64, now: f64) -> bool {
        match self {
            Self::RisesAbove(level) => before <= level && now > level,
            Self::FallsBelow(level) => before >= level && now < level,
            _ => false,
        }
    }

    fn is_crossing(self) -> bool {
        matches!(self, Self::RisesAbove(_) | Self::FallsBelow(_))
    }
}

fn in_brackets(words: Option<String>) -> String {
    words.map_or(String::new(), |words| format!(" ({words})"))
}

fn has_bit(value: f64, bit: u8) -> bool {
    value as u64 >> bit & 1 == 1
}

impl std::fmt::Display for Bound {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::MaxAbs(v) => write!(f, "|x| ≤ {v}"),
            Self::Min(v) => write!(f, "≥ {v}"),
            Self::Max(v) => write!(f, "≤ {v}"),
            Self::Equals(v) => write!(f, "= {v}"),
            Self::Within { value, tolerance } => write!(f, "{value} ± {tolerance}"),
            Self::HasBit(n) => write!(f, "has bit {n}"),
            Self::LacksBit(n) => write!(f, "lacks bit {n}"),
            Self::RisesAbove(v) => write!(f, "rises above {v}"),
            Self::FallsBelow(v) => write!(f, "falls below {v}"),
        }
    }
}

/// A value and its time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    pub at: Ps,
    pub value: f64,
}

/// The outcome of one bound of one expectation.
#[derive(Clone, Debug)]
pub struct Verdict {
    pub signal: String,
    /// The bound in words.
    pub expected: String,
    pub window: Window,
    pub because: Option<String>,
    /// The reading nearest to breaking the bound, the one that broke it most, or the crossing.
    pub decisive: Option<Reading>,
    /// Number of readings that were judged.
    pub readings: u64,
    /// The reason in words; `None` if the bound held.
    pub failure: Option<String>,
}

/// Judges one bound over a run.
#[derive(Debug)]
pub struct Judge {
    bound: Bound,
    window: Window,
    previous: Option<f64>,
    decisive: Option<Reading>,
    worst_excess: f64,
    crossed: bool,
    readings: u64,
}

impl Judge {
    pub fn new(bound: Bound, window: Window) -> Self {
        Self {
            bound,
            window,
            previous: None,
            decisive: None,
            worst_excess: 0.0,
            crossed: false,
            readings: 0,
        }
    }

    /// Takes the signal's value at `at`. Times must not decrease.
    pub fn see(&mut self, at: Ps, value: f64) {
        let inside = if self.window.is_instant() {
            at >= self.window.start && self.readings == 0
        } else {
            (self.window.start..=self.window.end).contains(&at)
        };
        if inside {
            self.readings += 1;
            self.judge(Reading { at, value });
            self.previous = Some(value);
        }
    }

    fn judge(&mut self, reading: Reading) {
        if self.bound.is_crossing() {
            let before = self.previous.unwrap_or(reading.value);
            let crosses = self.bound.crossed(before, reading.value);
            if !self.crossed {
                self.decisive = Some(reading);
                self.crossed = crosses;
            }
            return;
        }
        let excess = self.bound.excess(reading.value);
        let first = self.decisive.is_none();
        let extreme = self
            .decisive
            .is_some_and(|d| self.is_nearer_to_breaking(reading.value, d.value));
        if first || excess > self.worst_excess || (self.worst_excess == 0.0 && extreme) {
            self.worst_excess = excess;
            self.decisive = Some(reading);
        }
    }

    fn is_nearer_to_breaking(&self, a: f64, b: f64) -> bool {
        let margin = |v: f64| match self.bound {
            Bound::MaxAbs(_) => -v.abs(),
            Bound::Min(_) => v,
            Bound::Max(_) => -v,
            Bound::Equals(wanted) | Bound::Within { value: wanted, .. } => -(v - wanted).abs(),
            _ => 0.0,
        };
        margin(a) < margin(b)
    }

    /// Ends the judgement. `end` is the actual end of the run, and a bound whose window was cut off has not held.
    pub fn finish(
        self,
        signal: &str,
        because: Option<String>,
        end: Ps,
        meaning: Option<&Meaning>,
    ) -> Verdict {
        let failure = self.failure(end, meaning);
        Verdict {
            signal: signal.to_owned(),
            expected: self.bound.in_words(meaning),
            window: self.window,
            because,
            decisive: self.decisive,
            readings: self.readings,
            failure,
        }
    }

    fn failure(&self, end: Ps, meaning: Option<&Meaning>) -> Option<String> {
        let seconds = time::to_seconds;
        if self.worst_excess > 0.0 {
            let worst = self.decisive?;
            return Some(format!(
                "was {}{} at {:.4} s",
                readable(worst.value),
                in_brackets(meaning.and_then(|m| m.words(worst.value))),
                seconds(worst.at)
            ));
        }
        if self.bound.is_crossing() && self.readings > 0 && !self.crossed {
            return Some("never did".into());
        }
        if end < self.window.end {
            return Some(format!(
                "the run ended at {:.4} s, before this window did",
                seconds(end)
            ));
        }
        (self.readings == 0).then(|| "the signal had no value in this window".into())
    }
}

/// Six significant digits are enough to see what is wrong; very large and very small numbers get an exponent.
pub fn readable(value: f64) -> String {
    let rounded = format!("{value:.5e}").parse().unwrap_or(value);
    if rounded == 0.0 || (1e-6..1e9).contains(&rounded.abs()) || !rounded.is_finite() {
        rounded.to_string()
    } else {
        format!("{rounded:e}")
    }
}

/// The verdict on an expectation of a signal or flag that does not exist.
pub fn unjudgeable(expectation: &Expectation, expected: String, why: String) -> Verdict {
    Verdict {
        signal: expectation.signal.clone(),
        expected,
        window: expectation.window,
        because: expectation.because.clone(),
        decisive: None,
        readings: 0,
        failure: Some(why),
    }
}

#[cfg(test)]
mod tests;
