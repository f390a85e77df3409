//! Timing of the control tick, from the entries of its function.

use robot_emulator::core::stats::FunctionEntry;
use robot_plant::time::{MS, Ps, US};

/// Longest duration of a tick: 12,000 instructions of one cycle each.
const TICK_LASTS: Ps = 72 * US;
/// The control tick's period.
const TICK: Ps = MS;
const JITTER_BIN: Ps = US / 2;

/// Distribution of a measured quantity.
#[derive(Clone, Debug, Default, serde::Serialize)]
pub struct Distribution {
    pub mean: f64,
    pub p50: f64,
    pub p99: f64,
    pub max: f64,
}

/// Longest time from one control tick to the next within a boot, stalls included.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct LongestGap {
    pub armed: Ps,
    pub disarmed: Ps,
}

/// The control ticks of a run. A stall of the core by the flash counts as a gap, and not as missed ticks.
#[derive(Debug, Default)]
pub(super) struct TickStats {
    ticks: Vec<FunctionEntry>,
    /// Index of the first tick after each boot but the first.
    boots: Vec<usize>,
    /// Index of the first tick of each grid but the first: a boot starts one, and a stall of a period and more.
    grids: Vec<usize>,
    missed: u64,
    /// Whether the firmware last reported to be armed.
    armed: bool,
    longest_gap: LongestGap,
}

impl TickStats {
    /// Takes over the ticks since the last call. `entries` holds all ticks of the run.
    pub fn follow(&mut self, entries: &[FunctionEntry]) {
        for &tick in entries.get(self.ticks.len()..).unwrap_or_default() {
            self.add(tick);
        }
    }

    fn add(&mut self, tick: FunctionEntry) {
        let first = self.boots.last().copied().unwrap_or(0);
        if let Some(before) = self.ticks.get(first..).and_then(|run| run.last()) {
            let gap = tick.at - before.at;
            let running = gap.saturating_sub(tick.stood_still);
            self.missed += ((running + TICK / 2) / TICK).saturating_sub(1);
            let longest = if self.armed {
                &mut self.longest_gap.armed
            } else {
                &mut self.longest_gap.disarmed
            };
            *longest = gap.max(*longest);
        }
        if tick.stood_still >= TICK {
            self.grids.push(self.ticks.len());
        }
        self.ticks.push(tick);
    }

    /// Sets whether the firmware is armed, for the gaps that end from now on.
    pub fn set_armed(&mut self, armed: bool) {
        self.armed = armed;
    }

    /// Notes a reset of the chip after the last tick that [`Self::follow`] has seen.
    pub fn rebooted(&mut self) {
        self.armed = false;
        self.boots.push(self.ticks.len());
        self.grids.push(self.ticks.len());
    }

    pub fn longest_gap(&self) -> LongestGap {
        self.longest_gap
    }

    pub fn count(&self) -> u64 {
        self.ticks.len() as u64
    }

    /// Number of ticks, and entry time of the last one.
    pub fn so_far(&self) -> Option<(u64, Ps)> {
        let last = self.ticks.last()?;
        Some((self.count(), last.at))
    }

    /// Entry time of the last tick that has ended by `now`. A tick takes at most [`TICK_LASTS`].
    pub fn last_over(&self, now: Ps) -> Option<Ps> {
        let over = |tick: &&FunctionEntry| tick.at + TICK_LASTS <= now;
        self.ticks.iter().rev().find(over).map(|tick| tick.at)
    }

    /// Number of periods without a tick.
    pub fn missed(&self) -> u64 {
        self.missed
    }

    /// Instructions of the control executor from one tick to the next.
    pub fn instructions(&self) -> Distribution {
        distribution(
            self.pairs()
                .map(|(a, b)| (b.executed - a.executed) as f64)
                .collect(),
        )
    }

    /// Deviation of each tick from the 1 ms grid of its boot, counted from the earliest. A stall of the flash starts
    /// a new grid, and ticks held up by one do not count.
    pub fn release_jitter_us(&self) -> Distribution {
        distribution(
            self.jitter()
                .iter()
                .map(|&ps| ps as f64 / US as f64)
                .collect(),
        )
    }

    /// Counts of release jitter in 0.5 µs bins.
    pub fn jitter_bins(&self) -> Vec<u64> {
        let mut bins = Vec::new();
        for ps in self.jitter() {
            let bin = (ps / JITTER_BIN) as usize;
            if bins.len() <= bin {
                bins.resize(bin + 1, 0);
            }
            bins[bin] += 1;
        }
        bins
    }

    /// The ticks, split into the runs that begin at the indices in `starts`.
    fn runs<'a>(&'a self, starts: &'a [usize]) -> impl Iterator<Item = &'a [FunctionEntry]> {
        let ends = starts.iter().copied().chain([self.ticks.len()]);
        let starts = std::iter::once(0).chain(starts.iter().copied());
        starts.zip(ends).map(|(start, end)| &self.ticks[start..end])
    }

    fn pairs(&self) -> impl Iterator<Item = (FunctionEntry, FunctionEntry)> {
        self.runs(&self.boots)
            .flat_map(|run| run.windows(2).map(|w| (w[0], w[1])))
    }

    fn jitter(&self) -> Vec<Ps> {
        let mut all = Vec::with_capacity(self.ticks.len());
        for run in self.runs(&self.grids) {
            let run: Vec<&FunctionEntry> = run.iter().filter(|t| t.stood_still == 0).collect();
            let Some(first) = run.first() else { continue };
            // Phase on the grid, shifted by half a period so that early ticks do not wrap.
            let phase = |t: &&FunctionEntry| (t.at + TICK + TICK / 2 - first.at % TICK) % TICK;
            let earliest = run.iter().map(phase).min().unwrap_or(0);
            all.extend(run.iter().map(|tick| phase(tick) - earliest));
        }
        all
    }
}

fn distribution(mut values: Vec<f64>) -> Distribution {
    if values.is_empty() {
        return Distribution::default();
    }
    values.sort_by(f64::total_cmp);
    let at = |share: f64| values[((values.len() - 1) as f64 * share).round() as usize];
    Distribution {
        mean: values.iter().sum::<f64>() / values.len() as f64,
        p50: at(0.5),
        p99: at(0.99),
        max: at(1.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tick(at_us: u64, executed: u64, stood_still_us: u64) -> FunctionEntry {
        FunctionEntry {
            at: at_us * US,
            executed,
            stood_still: stood_still_us * US,
        }
    }

    #[test]
    fn late_ticks_count_as_jitter_and_gaps_as_missed() {
        let mut run = TickStats::default();
        let starts_us = [5_000_u64, 6_000, 7_003, 8_000, 10_000, 11_001];
        let ticks = starts_us.into_iter().zip(0..);
        let mut ticks: Vec<_> = ticks.map(|(at, n)| tick(at, 100 * n, 0)).collect();
        run.follow(&ticks);
        assert_eq!(run.count(), 6);
        assert_eq!(run.missed(), 1, "nothing came at 9 ms");
        assert_eq!(run.release_jitter_us().max, 3.0);
        assert_eq!(run.jitter_bins(), [4, 0, 1, 0, 0, 0, 1]);
        assert_eq!(run.instructions().mean, 100.0);
        run.rebooted();
        ticks.push(tick(90_000, 600, 0));
        run.follow(&ticks);
        assert_eq!(run.missed(), 1, "none is due while the chip boots");
    }

    #[test]
    fn the_last_tick_is_the_last_that_is_over() {
        let mut run = TickStats::default();
        assert_eq!(run.last_over(MS), None);
        run.follow(&[tick(1_000, 0, 0), tick(2_000, 0, 0), tick(3_000, 0, 0)]);
        assert_eq!(run.last_over(3 * MS + 10 * US), Some(2 * MS));
        assert_eq!(run.last_over(3 * MS + 80 * US), Some(3 * MS));
    }

    #[test]
    fn a_stall_of_the_flash_is_a_gap_and_neither_missed_ticks_nor_jitter() {
        let mut run = TickStats::default();
        // The grid begins anew after the stall, 300 µs off the old one.
        let mut ticks = vec![
            tick(5_000, 0, 0),
            tick(6_000, 0, 0),
            tick(256_010, 0, 250_000),
            tick(257_310, 0, 0),
            tick(258_310, 0, 0),
        ];
        run.follow(&ticks);
        run.set_armed(true);
        ticks.push(tick(259_326, 0, 16));
        run.follow(&ticks);
        assert_eq!(run.missed(), 0);
        assert_eq!(run.release_jitter_us().max, 0.0);
        let gaps = LongestGap {
            armed: 1_016 * US,
            disarmed: 250_010 * US,
        };
        assert_eq!(run.longest_gap(), gaps);
        // One tick is really missing beside a second stall.
        ticks.push(tick(259_326 + 252_000, 0, 250_000));
        run.follow(&ticks);
        assert_eq!(run.missed(), 1);
    }
}
