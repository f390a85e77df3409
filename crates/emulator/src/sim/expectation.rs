//! What must hold in a run, judged sample by sample while it runs.

use robot_plant::time::{self, Ps};

use crate::machine::diagnostics::meaning::Meaning;

#[derive(Clone, Debug)]
pub struct Expectation {
    pub signal: String,
    pub window: Window,
    /// All of them must hold; never empty.
    pub bounds: Vec<Bound>,
    /// Why this is expected, shown in the report.
    pub because: Option<String>,
}

/// Both ends belong to the window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    pub start: Ps,
    pub end: Ps,
}

impl Window {
    /// One instant: judged at the first sample at or after it.
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

    /// How far `value` oversteps this bound: 0 where it holds, infinite for what is not a number.
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

    /// As `Display`, with the firmware's own name of a state or flag.
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

/// A value and when it was seen.
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
    /// Readings judged.
    pub readings: u64,
    /// `None` = held; else the reason in words.
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

    /// Takes the signal's value at `at`; times never go backwards.
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

    /// `end` is when the run really ended: a window that was cut off has not been kept.
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

/// Six significant digits are enough to see what is wrong; what would need many zeros takes an exponent.
pub fn readable(value: f64) -> String {
    let rounded = format!("{value:.5e}").parse().unwrap_or(value);
    if rounded == 0.0 || (1e-6..1e9).contains(&rounded.abs()) || !rounded.is_finite() {
        rounded.to_string()
    } else {
        format!("{rounded:e}")
    }
}

/// The verdict on a signal that does not exist.
pub fn missing_signal(expectation: &Expectation, bound: Bound, why: String) -> Verdict {
    Verdict {
        signal: expectation.signal.clone(),
        expected: bound.to_string(),
        window: expectation.window,
        because: expectation.because.clone(),
        decisive: None,
        readings: 0,
        failure: Some(why),
    }
}

#[cfg(test)]
mod tests {
    use robot_plant::time::MS;

    use super::*;

    /// Feeds one value a millisecond from 0 and returns the verdict.
    fn run(bound: Bound, window: (Ps, Ps), values: &[f64]) -> Verdict {
        let window = Window {
            start: window.0 * MS,
            end: window.1 * MS,
        };
        let mut judge = Judge::new(bound, window);
        for (i, v) in values.iter().enumerate() {
            judge.see(i as Ps * MS, *v);
        }
        judge.finish("s", None, (values.len() as Ps - 1) * MS, None)
    }

    #[test]
    fn bounds_hold_or_fail_on_their_edge() {
        let values = [9.0, 1.0, -2.0, 1.5, 9.0];
        for (bound, holds) in [
            (Bound::MaxAbs(2.0), true),
            (Bound::MaxAbs(1.99), false),
            (Bound::Min(-2.0), true),
            (Bound::Min(-1.9), false),
            (Bound::Max(1.5), true),
            (Bound::Max(1.4), false),
            (Bound::Equals(1.0), false),
            (
                Bound::Within {
                    value: 0.0,
                    tolerance: 2.0,
                },
                true,
            ),
            (
                Bound::Within {
                    value: 0.1,
                    tolerance: 2.0,
                },
                false,
            ),
        ] {
            let verdict = run(bound, (1, 3), &values);
            assert_eq!(verdict.failure.is_none(), holds, "{bound}: {verdict:?}");
        }
    }

    #[test]
    fn flags_are_judged_by_their_bit() {
        let flags = [0.0, 5.0, 4.0, 6.0, 0.0];
        for (bound, holds) in [
            (Bound::HasBit(2), true),
            (Bound::HasBit(0), false),
            (Bound::LacksBit(3), true),
            (Bound::LacksBit(1), false),
        ] {
            assert_eq!(
                run(bound, (1, 3), &flags).failure.is_none(),
                holds,
                "{bound}"
            );
        }
    }

    #[test]
    fn a_failure_names_the_worst_reading() {
        let verdict = run(Bound::MaxAbs(0.0), (0, 4), &[0.0, 1.0, -3.0, 2.0, 0.0]);
        let worst = Reading {
            at: 2 * MS,
            value: -3.0,
        };
        assert_eq!(verdict.decisive, Some(worst));
        assert_eq!(verdict.failure.as_deref(), Some("was -3 at 0.0020 s"));
    }

    #[test]
    fn states_and_flags_are_called_by_their_names() {
        let flags = Meaning::Flags([(0, "lost".to_owned()), (3, "e-stop".to_owned())].into());
        let window = Window { start: 0, end: MS };
        let mut judge = Judge::new(Bound::LacksBit(3), window);
        judge.see(0, 9.0);
        let verdict = judge.finish("s", None, MS, Some(&flags));
        assert_eq!(verdict.expected, "lacks bit 3 (e-stop)");
        let why = verdict.failure.as_deref();
        assert_eq!(why, Some("was 9 (lost e-stop) at 0.0000 s"));
    }

    #[test]
    fn nothing_seen_is_a_failure() {
        assert!(
            run(Bound::MaxAbs(1.0), (5, 9), &[0.0; 20])
                .failure
                .is_none()
        );
        assert!(run(Bound::MaxAbs(1.0), (5, 9), &[0.0; 8]).failure.is_some());
        let between_samples = Window {
            start: MS / 4,
            end: MS / 2,
        };
        let mut judge = Judge::new(Bound::Max(1.0), between_samples);
        judge.see(0, 0.0);
        judge.see(MS, 0.0);
        assert!(judge.finish("s", None, MS, None).failure.is_some());
    }

    #[test]
    fn values_are_short_whatever_their_size() {
        assert_eq!(readable(0.592_001_23), "0.592001");
        assert_eq!(readable(-1.234_567_8e-300), "-1.23457e-300");
        assert_eq!(readable(0.0), "0");
        assert_eq!(readable(f64::NAN), "NaN");
    }

    #[test]
    fn not_a_number_never_passes() {
        for bound in [Bound::MaxAbs(1.0), Bound::Min(0.0), Bound::Equals(0.0)] {
            assert!(run(bound, (0, 2), &[0.0, f64::NAN, 0.0]).failure.is_some());
        }
    }

    #[test]
    fn a_crossing_happens_inside_the_window() {
        let step = [0.0, 0.0, 1.0, 1.0, 0.0];
        assert!(run(Bound::RisesAbove(0.5), (0, 3), &step).failure.is_none());
        assert!(run(Bound::RisesAbove(0.5), (2, 3), &step).failure.is_some());
        assert!(run(Bound::FallsBelow(0.5), (2, 4), &step).failure.is_none());
        assert!(run(Bound::FallsBelow(0.5), (0, 3), &step).failure.is_some());
    }

    #[test]
    fn an_instant_is_judged_once_at_the_next_sample() {
        let window = Window::instant(3 * MS / 2);
        let mut judge = Judge::new(Bound::Equals(2.0), window);
        for (at, value) in [(MS, 1.0), (2 * MS, 2.0), (3 * MS, 3.0)] {
            judge.see(at, value);
        }
        let verdict = judge.finish("s", None, 3 * MS, None);
        assert_eq!((verdict.readings, verdict.failure), (1, None));
    }
}
