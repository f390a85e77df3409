//! Jitter of the control tick, measured with the cycle counter of the core. The counter is independent of the timer that
//! releases the tick, and 168 times as fine.

use cortex_m::peripheral::DWT;

use crate::stall::clock_repair;

/// The system clock.
const CYCLES_A_MS: u32 = 168_000;

/// Measures the jitter of the control tick.
pub struct CycleJitter {
    /// Cycle count of the last tick, or `None` if it must not be compared.
    last: Option<u32>,
    max_cycles: u32,
}

impl CycleJitter {
    /// Starts the counter.
    pub fn start() -> Self {
        // If it cannot be started, it stands still, which `tick` notices.
        clock_repair::start_cycle_counter();
        Self {
            last: None,
            max_cycles: 0,
        }
    }

    /// Skips the next interval, because the chip stood still in it.
    pub fn restart(&mut self) {
        self.last = None;
    }

    /// Notes the start of a tick.
    pub fn tick(&mut self) {
        let now = DWT::cycle_count();
        if let Some(last) = self.last.replace(now)
            && last != now
        {
            let cycles = now.wrapping_sub(last);
            self.max_cycles = self.max_cycles.max(cycles.abs_diff(CYCLES_A_MS));
        }
    }

    /// Largest deviation of the tick interval from 1 ms since boot, in cycles; 0 if the counter stands still.
    pub fn max_cycles(&self) -> u32 {
        self.max_cycles
    }
}
