//! Programs and erases since power-on.

use std::ops::Range;

use crate::time::Ps;

/// A program or an erase that the image requested, whether interrupted or not.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FlashStep {
    /// Time at which it began. The core stood still from then on.
    pub at: Ps,
    /// Program or erase.
    pub kind: FlashStepKind,
    /// Address of the word, or of the sector's first word.
    pub address: u32,
}

/// Kind of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FlashStepKind {
    /// A word, half-word or byte is programmed.
    Program,
    /// A sector is erased.
    Erase,
}

/// Counters since power-on. The single bank of this chip serves no fetch while it is busy.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FlashStats {
    pub erases: u64,
    pub programs: u64,
    pub longest_stall: Ps,
}

#[derive(Debug, Default)]
pub struct History {
    steps: Vec<FlashStep>,
    stats: FlashStats,
}

impl History {
    pub fn begun(&mut self, step: FlashStep, work: &Range<Ps>) {
        match step.kind {
            FlashStepKind::Program => self.stats.programs += 1,
            FlashStepKind::Erase => self.stats.erases += 1,
        }
        let stall = work.end - work.start;
        self.stats.longest_stall = self.stats.longest_stall.max(stall);
        self.steps.push(step);
    }

    pub fn steps(&self) -> &[FlashStep] {
        &self.steps
    }

    pub fn stats(&self) -> FlashStats {
        self.stats
    }
}
