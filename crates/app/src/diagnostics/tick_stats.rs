//! How regularly the control tick runs.

use crate::domain::age_us;

/// The tick's nominal period.
const PERIOD_US: u32 = 1_000;

/// Times as the control task sees them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct TickStats {
    /// Ticks since boot; wraps.
    pub count: u32,
    /// Since the tick before.
    pub dt_us: u32,
    /// Distance of `dt_us` from the period.
    pub jitter_us: u32,
    pub max_jitter_us: u32,
    /// The same by the core's cycle counter (DWT), 168 a microsecond, and of the task's entry; 0 if that does not run.
    pub max_jitter_cycles: u32,
    /// Whole periods in which no tick ran.
    pub missed: u32,
    /// Times the whole chip stood still for a flash erase.
    pub stalls: u32,
    pub longest_stall_us: u32,
    pub ts_us: u64,
}

impl TickStats {
    /// The chip stood still since the last tick: the next one is the first of a new series, neither late nor missed.
    pub fn stalled(&mut self, stall_us: u32) {
        self.stalls = self.stalls.saturating_add(1);
        self.longest_stall_us = self.longest_stall_us.max(stall_us);
        self.ts_us = 0;
    }

    /// Time that runs backwards counts as standing still.
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
    fn a_stall_is_neither_missed_nor_jitter() {
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
