//! Timing statistics of the control tick.

use crate::domain::age_us;

/// The tick's nominal period.
const PERIOD_US: u32 = 1_000;

/// Timing as measured by the control task.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct TickStats {
    /// Number of ticks since boot; it wraps.
    pub count: u32,
    /// Time since the previous tick.
    pub dt_us: u32,
    /// Deviation of `dt_us` from the period.
    pub jitter_us: u32,
    /// Largest `jitter_us` since boot.
    pub max_jitter_us: u32,
    /// Largest jitter of the task's entry by the core's cycle counter (DWT), 168 counts per µs; 0 if the counter does
    /// not run.
    pub max_jitter_cycles: u32,
    /// Number of periods in which no tick ran.
    pub missed: u32,
    /// Number of times the whole chip stood still for a flash erase.
    pub stalls: u32,
    /// Duration of the longest stall.
    pub longest_stall_us: u32,
    /// Time of the last tick.
    pub ts_us: u64,
}

impl TickStats {
    /// Records a stall of the chip. The next tick starts a new series and counts as neither late nor missed.
    pub fn stalled(&mut self, stall_us: u32) {
        self.stalls = self.stalls.saturating_add(1);
        self.longest_stall_us = self.longest_stall_us.max(stall_us);
        self.ts_us = 0;
    }

    /// Records a tick. A time that runs backwards counts as no progress.
    pub fn tick(&mut self, now_us: u64) {
        if self.ts_us > 0 {
            self.dt_us = age_us(self.ts_us, now_us);
            self.jitter_us = self.dt_us.abs_diff(PERIOD_US);
            self.max_jitter_us = self.max_jitter_us.max(self.jitter_us);
            let periods = self.dt_us.saturating_add(PERIOD_US / 2) / PERIOD_US;
            self.missed = self.missed.saturating_add(periods.saturating_sub(1));
        }
        self.count = self.count.wrapping_add(1);
        self.ts_us = now_us;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_skipped_tick_is_counted_once() {
        let mut stats = TickStats::default();
        for now_us in [1_000, 2_000, 3_004, 6_001, 7_001] {
            stats.tick(now_us);
        }
        assert_eq!((stats.count, stats.missed), (5, 2));
        assert_eq!((stats.dt_us, stats.jitter_us), (1_000, 0));
        assert_eq!(stats.max_jitter_us, 1_997);
    }

    #[test]
    fn a_stall_counts_neither_as_missed_nor_as_jitter() {
        let mut stats = TickStats::default();
        stats.tick(1_000);
        stats.stalled(250_700);
        for now_us in [251_900, 252_900, 253_903] {
            stats.tick(now_us);
        }
        assert_eq!((stats.count, stats.missed), (4, 0));
        assert_eq!((stats.dt_us, stats.max_jitter_us), (1_003, 3));
        stats.stalled(3_000);
        assert_eq!((stats.stalls, stats.longest_stall_us), (2, 250_700));
    }
}
