//! Measurements of a run: instructions by context, entries of a watched function, busy and idle cycles.

use std::collections::BTreeMap;

use crate::{
    core::exception::{EXCEPTION_COUNT, Exception},
    time::Ps,
};

/// Counters that the engine's hooks update.
#[derive(Debug)]
pub struct Execution {
    executed: [u64; EXCEPTION_COUNT],
    /// Busy and idle cycles since the core clock last changed.
    pub(crate) busy_cycles: u64,
    pub(crate) idle_cycles: u64,
    entries: Vec<FunctionEntry>,
    /// How long the core has stood still since the last entry.
    stood_still: Ps,
}

/// The watched function was entered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FunctionEntry {
    /// When it was entered.
    pub at: Ps,
    /// Instructions of its context since power-on.
    pub executed: u64,
    /// How long the core had stood still since the entry before, or since the reset.
    pub stood_still: Ps,
}

impl Default for Execution {
    fn default() -> Self {
        Self {
            executed: [0; EXCEPTION_COUNT],
            busy_cycles: 0,
            idle_cycles: 0,
            entries: Vec::new(),
            stood_still: 0,
        }
    }
}

impl Execution {
    pub(crate) fn ran(&mut self, context: Exception, instructions: u16, cycles: u16) {
        self.executed[context.index()] += u64::from(instructions);
        self.busy_cycles += u64::from(cycles);
    }

    pub(crate) fn clock_changed(&mut self) {
        self.busy_cycles = 0;
        self.idle_cycles = 0;
    }

    /// Records a time in which the core fetched nothing. It counts as neither busy nor idle.
    pub(crate) fn stood_still(&mut self, time: Ps) {
        self.stood_still += time;
    }

    /// The watched function was entered.
    pub(crate) fn entered(&mut self, at: Ps, context: Exception) {
        self.entries.push(FunctionEntry {
            at,
            executed: self.executed[context.index()],
            stood_still: std::mem::take(&mut self.stood_still),
        });
    }

    pub(crate) fn rebooted(&mut self) {
        self.stood_still = 0;
    }

    /// Every entry of the watched function since power-on.
    pub fn entries(&self) -> &[FunctionEntry] {
        &self.entries
    }

    /// Busy share of the core since its clock last changed, 0 … 1.
    pub fn cpu_load(&self) -> f64 {
        let all = self.busy_cycles + self.idle_cycles;
        if all == 0 {
            0.0
        } else {
            self.busy_cycles as f64 / all as f64
        }
    }

    /// Share of all instructions by context: interrupt name, or `thread`.
    pub fn shares(&self) -> BTreeMap<String, f64> {
        let all: u64 = self.executed.iter().sum();
        (0..)
            .map_while(Exception::from_number)
            .zip(self.executed)
            .filter(|&(_, n)| n > 0)
            .map(|(e, n)| (e.name().to_owned(), n as f64 / all as f64))
            .collect()
    }
}
