//! Rate and jitter of the frames that the PC receives.

use std::collections::VecDeque;

use crate::time::{Ps, US, to_seconds};

/// Number of intervals over which rate and jitter are taken.
const INTERVALS: usize = 128;

/// Counts the frames and measures the intervals between the ends of their last stop bits.
#[derive(Clone, Debug, Default)]
pub(crate) struct Meter {
    frames: u64,
    last: Option<Ps>,
    intervals: VecDeque<Ps>,
}

impl Meter {
    pub(super) fn frame(&mut self, at: Ps) {
        self.frames += 1;
        if let Some(last) = self.last.replace(at) {
            if self.intervals.len() == INTERVALS {
                self.intervals.pop_front();
            }
            self.intervals.push_back(at - last);
        }
    }

    pub(crate) fn frames(&self) -> u64 {
        self.frames
    }

    /// The last interval; NaN before the second frame.
    pub(crate) fn interval_us(&self) -> f64 {
        let last = self.intervals.back();
        last.map_or(f64::NAN, |interval| *interval as f64 / US as f64)
    }

    /// Frames a second in the mean of the last intervals, 0 before the second frame and after a silence that makes it fewer
    /// than one.
    pub(crate) fn rate_hz(&self, now: Ps) -> f64 {
        let silent = self
            .last
            .is_none_or(|last| now > last + crate::time::SECOND);
        let sum: Ps = self.intervals.iter().sum();
        if silent || sum == 0 {
            return 0.0;
        }
        self.intervals.len() as f64 / to_seconds(sum)
    }

    /// The largest deviation of one of the last intervals from their mean.
    pub(crate) fn jitter_us(&self) -> f64 {
        let sum: Ps = self.intervals.iter().sum();
        let mean = sum as f64 / self.intervals.len() as f64;
        let off = self.intervals.iter().map(|i| (*i as f64 - mean).abs());
        off.fold(0.0, f64::max) / US as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::time::{MS, SECOND};

    #[test]
    fn rate_and_jitter_are_those_of_the_last_intervals() {
        let mut meter = Meter::default();
        assert_eq!(meter.rate_hz(0), 0.0);
        let mut at = 0;
        for n in 0..201 {
            meter.frame(at);
            at += if n % 2 == 0 { 2 * MS } else { 3 * MS };
        }
        assert_eq!(meter.rate_hz(at), 400.0);
        assert_eq!(meter.jitter_us(), 500.0);
        assert_eq!(meter.interval_us(), 3_000.0);
        assert_eq!(meter.rate_hz(at + 2 * SECOND), 0.0);
    }
}
