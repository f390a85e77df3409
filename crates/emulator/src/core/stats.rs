//! What the run itself measures: instructions by context, control-tick timing, CPU load.

use std::collections::BTreeMap;

use crate::{
    core::exception::{EXCEPTION_COUNT, Exception},
    time::{MS, Ps, US},
};

/// The 12,000 instructions that a tick may take, in as many cycles.
const TICK_LASTS: Ps = 72 * US;
/// The control tick's period.
const TICK: Ps = MS;
const JITTER_BIN: Ps = US / 2;

/// How a measured quantity is distributed.
#[derive(Clone, Debug, Default, serde::Serialize)]
pub struct Distribution {
    pub mean: f64,
    pub p50: f64,
    pub p99: f64,
    pub max: f64,
}

/// Counters that the engine's hooks feed.
#[derive(Debug)]
pub struct Execution {
    executed: [u64; EXCEPTION_COUNT],
    /// Busy and idle cycles since the core clock last changed.
    pub busy_cycles: u64,
    pub idle_cycles: u64,
    ticks: Vec<TickEntry>,
    /// Index of the first tick after each boot but the first.
    boots: Vec<usize>,
    /// Index of the first tick of each grid but the first: a boot starts one, and a stall of a period and more.
    grids: Vec<usize>,
    missed: u64,
    /// Since the last tick the core stood still for so long.
    stood_still: Ps,
    /// As the machine last knew it.
    armed: bool,
    longest_gap: LongestGap,
}

/// Longest time from one control tick to the next within a boot, stalls included.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LongestGap {
    pub armed: Ps,
    pub disarmed: Ps,
}

#[derive(Clone, Copy, Debug)]
struct TickEntry {
    at: Ps,
    /// Instructions of the tick's context up to here.
    executed: u64,
    /// The core stood still before it: it may be late for no fault of the image.
    held_up: bool,
}

impl Default for Execution {
    fn default() -> Self {
        Self {
            executed: [0; EXCEPTION_COUNT],
            busy_cycles: 0,
            idle_cycles: 0,
            ticks: Vec::new(),
            boots: Vec::new(),
            grids: Vec::new(),
            missed: 0,
            stood_still: 0,
            armed: false,
            longest_gap: LongestGap::default(),
        }
    }
}

impl Execution {
    pub fn ran(&mut self, context: Exception, instructions: u16, cycles: u16) {
        self.executed[context.index()] += u64::from(instructions);
        self.busy_cycles += u64::from(cycles);
    }

    pub fn clock_changed(&mut self) {
        self.busy_cycles = 0;
        self.idle_cycles = 0;
    }

    /// The core fetched nothing for so long. Neither busy nor idle.
    pub fn stood_still(&mut self, time: Ps) {
        self.stood_still += time;
    }

    /// Whether the firmware is armed, for the gaps that end from now on.
    pub fn set_armed(&mut self, armed: bool) {
        self.armed = armed;
    }

    /// The control tick's function was entered.
    pub fn tick_entered(&mut self, at: Ps, context: Exception) {
        let stood_still = std::mem::take(&mut self.stood_still);
        let first = self.boots.last().copied().unwrap_or(0);
        if let Some(before) = self.ticks.get(first..).and_then(|run| run.last()) {
            let gap = at - before.at;
            // A stall is the flash's doing; its length stands under `flash` and among the gaps.
            self.missed += ((gap.saturating_sub(stood_still) + TICK / 2) / TICK).saturating_sub(1);
            let longest = if self.armed {
                &mut self.longest_gap.armed
            } else {
                &mut self.longest_gap.disarmed
            };
            *longest = gap.max(*longest);
        }
        if stood_still >= TICK {
            self.grids.push(self.ticks.len());
        }
        self.ticks.push(TickEntry {
            at,
            executed: self.executed[context.index()],
            held_up: stood_still > 0,
        });
    }

    pub fn rebooted(&mut self) {
        self.stood_still = 0;
        self.armed = false;
        self.boots.push(self.ticks.len());
        self.grids.push(self.ticks.len());
    }

    pub fn longest_gap(&self) -> LongestGap {
        self.longest_gap
    }

    pub fn tick_count(&self) -> u64 {
        self.ticks.len() as u64
    }

    /// How many ticks there were, and when the last one was entered.
    pub fn ticks_so_far(&self) -> Option<(u64, Ps)> {
        let last = self.ticks.last()?;
        Some((self.tick_count(), last.at))
    }

    /// When the last tick was entered that is over by `now`; one takes at most [`TICK_LASTS`].
    pub fn last_tick(&self, now: Ps) -> Option<Ps> {
        let over = |tick: &&TickEntry| tick.at + TICK_LASTS <= now;
        self.ticks.iter().rev().find(over).map(|tick| tick.at)
    }

    /// Periods in which no tick came.
    pub fn missed_ticks(&self) -> u64 {
        self.missed
    }

    /// Instructions of the control executor from one tick to the next.
    pub fn tick_instructions(&self) -> Distribution {
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

    pub fn cpu_load(&self) -> f64 {
        let all = self.busy_cycles + self.idle_cycles;
        if all == 0 {
            0.0
        } else {
            self.busy_cycles as f64 / all as f64
        }
    }

    /// Share of all instructions by context.
    pub fn shares(&self) -> BTreeMap<String, f64> {
        let all: u64 = self.executed.iter().sum();
        (0..)
            .map_while(Exception::from_number)
            .zip(self.executed)
            .filter(|&(_, n)| n > 0)
            .map(|(e, n)| (e.name().to_owned(), n as f64 / all as f64))
            .collect()
    }

    /// The ticks, cut where the runs begin that `starts` lists.
    fn runs<'a>(&'a self, starts: &'a [usize]) -> impl Iterator<Item = &'a [TickEntry]> {
        let ends = starts.iter().copied().chain([self.ticks.len()]);
        let starts = std::iter::once(0).chain(starts.iter().copied());
        starts.zip(ends).map(|(start, end)| &self.ticks[start..end])
    }

    fn pairs(&self) -> impl Iterator<Item = (TickEntry, TickEntry)> {
        self.runs(&self.boots)
            .flat_map(|run| run.windows(2).map(|w| (w[0], w[1])))
    }

    fn jitter(&self) -> Vec<Ps> {
        let mut all = Vec::with_capacity(self.ticks.len());
        for run in self.runs(&self.grids) {
            let run: Vec<&TickEntry> = run.iter().filter(|tick| !tick.held_up).collect();
            let Some(first) = run.first() else { continue };
            // Phase on the grid, half a period of head-room so that early ticks do not wrap.
            let phase = |t: &&TickEntry| (t.at + TICK + TICK / 2 - first.at % TICK) % TICK;
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

    #[test]
    fn late_ticks_count_as_jitter_and_gaps_as_missed() {
        let mut run = Execution::default();
        let control = Exception::from_irq(53);
        let starts_us = [5_000_u64, 6_000, 7_003, 8_000, 10_000, 11_001];
        for at in starts_us {
            run.tick_entered(at * US, control);
            run.ran(control, 100, 100);
        }
        assert_eq!(run.tick_count(), 6);
        assert_eq!(run.missed_ticks(), 1, "nothing came at 9 ms");
        assert_eq!(run.release_jitter_us().max, 3.0);
        assert_eq!(run.jitter_bins(), [4, 0, 1, 0, 0, 0, 1]);
        assert_eq!(run.tick_instructions().mean, 100.0);
        run.rebooted();
        run.tick_entered(90_000 * US, control);
        assert_eq!(run.missed_ticks(), 1, "none is due while the chip boots");
    }

    #[test]
    fn the_last_tick_is_the_last_that_is_over() {
        let mut run = Execution::default();
        assert_eq!(run.last_tick(MS), None);
        let control = Exception::from_irq(53);
        for tick in 1..=3 {
            run.tick_entered(tick * MS, control);
        }
        assert_eq!(run.last_tick(3 * MS + 10 * US), Some(2 * MS));
        assert_eq!(run.last_tick(3 * MS + 80 * US), Some(3 * MS));
    }

    #[test]
    fn a_stall_of_the_flash_is_a_gap_and_neither_missed_ticks_nor_jitter() {
        let mut run = Execution::default();
        let control = Exception::from_irq(53);
        run.tick_entered(5_000 * US, control);
        run.tick_entered(6_000 * US, control);
        run.stood_still(250_000 * US);
        // The grid begins anew, 300 µs off the old one.
        for at in [256_010_u64, 257_310, 258_310] {
            run.tick_entered(at * US, control);
        }
        run.set_armed(true);
        run.stood_still(16 * US);
        run.tick_entered(259_326 * US, control);
        assert_eq!(run.missed_ticks(), 0);
        assert_eq!(run.release_jitter_us().max, 0.0);
        let gaps = LongestGap {
            armed: 1_016 * US,
            disarmed: 250_010 * US,
        };
        assert_eq!(run.longest_gap(), gaps);
        // One tick is really missing beside a second stall.
        run.stood_still(250_000 * US);
        run.tick_entered((259_326 + 252_000) * US, control);
        assert_eq!(run.missed_ticks(), 1);
    }
}
