//! How regularly something runs, by the core's own cycle counter: independent of the clock that wakes it, and 168 times
//! as fine.

use cortex_m::peripheral::DWT;

use crate::stall::clock_repair;

/// The system clock.
const CYCLES_A_MS: u32 = 168_000;

/// Of the control tick, once a millisecond.
pub struct CycleJitter {
    /// `None` if the tick before is not to be compared with.
    last: Option<u32>,
    max_cycles: u32,
}

impl CycleJitter {
    /// Starts the counter.
    pub fn start() -> Self {
        // Where it cannot be started it stands still, which `tick` sees.
        clock_repair::start_cycle_counter();
        Self {
            last: None,
            max_cycles: 0,
        }
    }

    /// The chip stood still.
    pub fn restart(&mut self) {
        self.last = None;
    }

    pub fn tick(&mut self) {
        let now = DWT::cycle_count();
        if let Some(last) = self.last.replace(now)
            && last != now
        {
            let cycles = now.wrapping_sub(last);
            self.max_cycles = self.max_cycles.max(cycles.abs_diff(CYCLES_A_MS));
        }
    }

    /// Largest distance of two ticks from a millisecond, since boot; 0 if the counter stands still.
    pub fn max_cycles(&self) -> u32 {
        self.max_cycles
    }
}
