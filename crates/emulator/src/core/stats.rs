//! What the run itself measures: instructions by context, control-tick timing, CPU load.

use std::collections::BTreeMap;

use robot_plant::time::{MS, Ps, US};

use crate::{
    core::exception::{EXCEPTION_COUNT, Exception},
    machine::Distribution,
};

/// The control tick's period.
const TICK: Ps = MS;
const JITTER_BIN: Ps = US / 2;

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
    missed: u64,
}

#[derive(Clone, Copy, Debug)]
struct TickEntry {
    at: Ps,
    /// Instructions of the tick's context up to here.
    executed: u64,
}

impl Default for Execution {
    fn default() -> Self {
        Self {
            executed: [0; EXCEPTION_COUNT],
            busy_cycles: 0,
            idle_cycles: 0,
            ticks: Vec::new(),
            boots: Vec::new(),
            missed: 0,
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

    /// The control tick's function was entered.
    pub fn tick_entered(&mut self, at: Ps, context: Exception) {
        let first = self.boots.last().copied().unwrap_or(0);
        if let Some(before) = self.ticks.get(first..).and_then(|run| run.last()) {
            self.missed += ((at - before.at + TICK / 2) / TICK).saturating_sub(1);
        }
        self.ticks.push(TickEntry {
            at,
            executed: self.executed[context.index()],
        });
    }

    pub fn rebooted(&mut self) {
        self.boots.push(self.ticks.len());
    }

    pub fn tick_count(&self) -> u64 {
        self.ticks.len() as u64
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

    /// Deviation of each tick from the 1 ms grid of its boot, counted from the earliest.
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

    /// The ticks of each boot.
    fn runs(&self) -> impl Iterator<Item = &[TickEntry]> {
        let ends = self.boots.iter().copied().chain([self.ticks.len()]);
        let starts = std::iter::once(0).chain(self.boots.iter().copied());
        starts.zip(ends).map(|(start, end)| &self.ticks[start..end])
    }

    fn pairs(&self) -> impl Iterator<Item = (TickEntry, TickEntry)> {
        self.runs()
            .flat_map(|run| run.windows(2).map(|w| (w[0], w[1])))
    }

    fn jitter(&self) -> Vec<Ps> {
        let mut all = Vec::with_capacity(self.ticks.len());
        for run in self.runs() {
            let Some(first) = run.first() else { continue };
            // Phase on the grid, half a period of head-room so that early ticks do not wrap.
            let phase = |t: &TickEntry| (t.at + TICK + TICK / 2 - first.at % TICK) % TICK;
            let earliest = run.iter().map(phase).min().unwrap_or(0);
            all.extend(run.iter().map(|t| phase(t) - earliest));
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
}
