//! The beat of a run: when the next cycle is due, how late each was, and whether the computer keeps up.

use std::time::{Duration, Instant};

use crate::limits::Stop;

/// Width in s of a bin of the histogram.
const BIN_S: f64 = 1e-5;
/// Bins of the histogram; the last one holds all that is later, from 0.1 s on.
const BINS: usize = 10_000;
/// Late runs of the network in a row that end the run.
const MISSES_IN_A_ROW: u32 = 3;
/// Lateness in s that ends the run at once: the robot takes a PC that is silent for 0.1 s for lost.
const HOLE_S: f64 = 0.08;
/// Time in s from a state of the robot to the next.
const STATE_PERIOD_S: f64 = 0.0024;

/// Gives out the times of the cycles.
#[derive(Clone, Debug)]
pub struct Pace {
    period: Duration,
    due: Instant,
}

impl Pace {
    /// The first cycle is due a period after `now`.
    pub fn new(period: Duration, now: Instant) -> Self {
        Self {
            period,
            due: now + period,
        }
    }

    /// Returns when the next cycle is due.
    pub fn due(&self) -> Instant {
        self.due
    }

    /// Returns how late the cycle is that begins now, and plans the next. What was missed is not made up for.
    pub fn begin(&mut self, now: Instant) -> Duration {
        let late = now.saturating_duration_since(self.due);
        self.due = if late > self.period {
            now + self.period
        } else {
            self.due + self.period
        };
        late
    }
}

/// Gives out the times of the cycles by the clock of a robot that waits for this program, as the emulated board can.
#[derive(Clone, Debug)]
pub struct RobotPace {
    period_s: f64,
    /// Time of the newest state; `None` before the first.
    heard_s: Option<f64>,
    /// `None` before the first state.
    due_s: Option<f64>,
}

impl RobotPace {
    /// Cycles are due at the multiples of the period.
    pub fn new(period: Duration) -> Self {
        Self {
            period_s: period.as_secs_f64(),
            heard_s: None,
            due_s: None,
        }
    }

    /// Takes the time of a state. Returns for how long in s the robot was silent before it: the age that the state before it had
    /// when it should have come, as the computer's clock would have it.
    pub fn hear(&mut self, time_s: f64) -> f64 {
        let before_s = self.heard_s.replace(time_s).unwrap_or(time_s);
        (time_s - before_s - STATE_PERIOD_S).max(0.0)
    }

    /// Returns how late the cycle is that begins with the state of this time, or `None` before it is due.
    pub fn begin(&mut self, time_s: f64) -> Option<Duration> {
        let late_s = time_s - self.due_s.unwrap_or(time_s);
        // A robot that was switched off and on counts from 0 again.
        let counts_anew = late_s < -self.period_s;
        if late_s < 0.0 && !counts_anew {
            return None;
        }
        self.due_s = Some(((time_s / self.period_s).floor() + 1.0) * self.period_s);
        Some(Duration::from_secs_f64(late_s.max(0.0)))
    }
}

/// How late the network's runs were. Its memory does not grow.
#[derive(Clone, Debug)]
pub struct Lateness {
    /// Time in s of lateness from which on a run is a miss.
    miss_s: f64,
    bins: Vec<u32>,
    runs: u64,
    sum_s: f64,
    min_s: f64,
    max_s: f64,
    misses: u64,
    misses_in_a_row: u32,
}

impl Lateness {
    /// Counts runs that come each `period_s`. One that is later than half of it is a miss.
    pub fn new(period_s: f64) -> Self {
        Self {
            miss_s: period_s / 2.0,
            bins: vec![0; BINS],
            runs: 0,
            sum_s: 0.0,
            min_s: f64::INFINITY,
            max_s: 0.0,
            misses: 0,
            misses_in_a_row: 0,
        }
    }

    /// Counts a run.
    ///
    /// # Errors
    /// It was the third miss in a row, or so late that the robot may have given up.
    pub fn add(&mut self, late: Duration) -> Result<(), Stop> {
        let late_s = late.as_secs_f64();
        let bin = ((late_s / BIN_S) as usize).min(BINS - 1);
        self.bins[bin] = self.bins[bin].saturating_add(1);
        self.runs += 1;
        self.sum_s += late_s;
        self.min_s = self.min_s.min(late_s);
        self.max_s = self.max_s.max(late_s);
        if late_s <= self.miss_s {
            self.misses_in_a_row = 0;
            return Ok(());
        }
        self.misses += 1;
        self.misses_in_a_row += 1;
        if self.misses_in_a_row < MISSES_IN_A_ROW && late_s < HOLE_S {
            return Ok(());
        }
        Err(Stop::Deadline {
            late_ms: 1e3 * late_s,
            misses: self.misses_in_a_row,
        })
    }

    /// Returns the summary; `None` without a run.
    pub fn summary(&self) -> Option<JitterSummary> {
        (self.runs > 0).then(|| JitterSummary {
            runs: self.runs,
            min_us: 1e6 * self.min_s,
            mean_us: 1e6 * self.sum_s / self.runs as f64,
            p99_us: 1e6 * self.quantile_s(0.99).min(self.max_s),
            max_us: 1e6 * self.max_s,
            misses: self.misses,
        })
    }

    /// The upper end of the bin that holds the quantile.
    fn quantile_s(&self, share: f64) -> f64 {
        let wanted = (share * self.runs as f64).ceil() as u64;
        let mut sum = 0;
        let bin = self.bins.iter().position(|count| {
            sum += u64::from(*count);
            sum >= wanted
        });
        match bin {
            Some(bin) if bin + 1 < BINS => (bin + 1) as f64 * BIN_S,
            _ => self.max_s,
        }
    }
}

/// How late runs of the network began.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JitterSummary {
    /// Runs of the network.
    pub runs: u64,
    /// Shortest lateness in µs.
    pub min_us: f64,
    /// Mean lateness in µs.
    pub mean_us: f64,
    /// Lateness in µs that 99 of 100 runs keep, rounded up to 10 µs.
    pub p99_us: f64,
    /// Longest lateness in µs.
    pub max_us: f64,
    /// Runs that were late by more than half of their period.
    pub misses: u64,
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: Duration = Duration::from_millis(1);

    #[test]
    fn what_was_missed_is_not_made_up_for() {
        let start = Instant::now();
        let mut pace = Pace::new(5 * MS, start);
        assert_eq!(pace.begin(start + 6 * MS), MS);
        assert_eq!(pace.due(), start + 10 * MS);
        assert_eq!(pace.begin(start + 30 * MS), 20 * MS);
        assert_eq!(pace.due(), start + 35 * MS);
    }

    #[test]
    fn the_robots_clock_gives_a_cycle_to_the_first_state_after_each_period() {
        let mut pace = RobotPace::new(5 * MS);
        let states_s = (1..=8).map(|n| 1.0 + 0.0024 * f64::from(n));
        let late_ms: Vec<_> = states_s
            .map(|time_s| pace.begin(time_s).map(|late| 1e3 * late.as_secs_f64()))
            .collect();
        let wanted = [
            Some(0.0),
            None,
            Some(2.2),
            None,
            Some(2.0),
            None,
            Some(1.8),
            None,
        ];
        for (late_ms, wanted) in late_ms.iter().zip(wanted) {
            let differ = late_ms.unwrap_or(-1.0) - wanted.unwrap_or(-1.0);
            assert!(differ.abs() < 1e-6, "{late_ms:?} {wanted:?}");
        }
        assert!(pace.begin(0.3).is_some(), "the robot was switched on anew");
        assert_eq!(pace.begin(0.3024), None);
    }

    #[test]
    fn a_gap_in_the_robots_states_is_their_age() {
        let mut pace = RobotPace::new(5 * MS);
        let near = |age_s: f64, wanted_s: f64| (age_s - wanted_s).abs() < 1e-9;
        assert!(near(pace.hear(7.0), 0.0), "nothing came before the first");
        assert!(near(pace.hear(7.0024), 0.0));
        assert!(near(pace.hear(7.2048), 0.2));
        assert!(near(pace.hear(0.5), 0.0), "it was switched on anew");
    }

    #[test]
    fn the_summary_has_the_hand_counted_values() {
        let mut lateness = Lateness::new(0.02);
        assert_eq!(lateness.summary(), None);
        for n in 1..=100 {
            lateness.add(n * MS / 10).expect("in time");
        }
        let summary = lateness.summary().expect("runs");
        assert_eq!((summary.runs, summary.misses), (100, 0));
        let near = |value: f64, wanted: f64| (value - wanted).abs() < 10.5;
        assert!(
            near(summary.min_us, 100.0) && near(summary.mean_us, 5_050.0),
            "{summary:?}"
        );
        assert!(
            near(summary.p99_us, 9_900.0) && near(summary.max_us, 10_000.0),
            "{summary:?}"
        );
    }

    #[test]
    fn the_third_miss_in_a_row_or_a_hole_ends_the_run() {
        let mut lateness = Lateness::new(0.02);
        for _ in 0..2 {
            assert_eq!(lateness.add(15 * MS), Ok(()));
            assert_eq!(lateness.add(15 * MS), Ok(()));
            assert_eq!(lateness.add(MS), Ok(()));
        }
        assert_eq!(lateness.add(15 * MS), Ok(()));
        assert_eq!(lateness.add(15 * MS), Ok(()));
        let stop = lateness.add(15 * MS).unwrap_err();
        assert_eq!(stop.name(), "deadline");
        assert_eq!(lateness.summary().expect("runs").misses, 7);
        assert!(Lateness::new(0.02).add(90 * MS).is_err());
    }
}
