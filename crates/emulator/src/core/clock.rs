//! CPU cycles as simulated time.

use crate::time::{Ps, SECOND};

/// Counts processor cycles and converts them exactly, across changes of the core clock.
#[derive(Clone, Copy, Debug)]
pub struct CycleClock {
    /// Cycles since power-on.
    pub cycles: u64,
    hz: u32,
    anchor_cycles: u64,
    anchor_ps: Ps,
}

impl CycleClock {
    pub fn new(hz: u32) -> Self {
        Self {
            cycles: 0,
            hz,
            anchor_cycles: 0,
            anchor_ps: 0,
        }
    }

    pub fn hz(&self) -> u32 {
        self.hz
    }

    pub fn now(&self) -> Ps {
        self.anchor_ps + to_ps(self.cycles - self.anchor_cycles, self.hz)
    }

    /// The first cycle that begins at or after `at`.
    pub fn cycle_at(&self, at: Ps) -> u64 {
        let since = u128::from(at.saturating_sub(self.anchor_ps));
        let cycles = (since * u128::from(self.hz)).div_ceil(u128::from(SECOND));
        self.anchor_cycles
            .saturating_add(u64::try_from(cycles).unwrap_or(u64::MAX))
    }

    /// Changes the clock's frequency: from now on a cycle lasts 1/`hz`.
    pub fn set_hz(&mut self, hz: u32) {
        self.anchor_ps = self.now();
        self.anchor_cycles = self.cycles;
        self.hz = hz;
    }
}

fn to_ps(cycles: u64, hz: u32) -> Ps {
    (u128::from(cycles) * u128::from(SECOND) / u128::from(hz)) as Ps
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::time::US;

    #[test]
    fn time_stays_exact_over_a_clock_change() {
        let mut clock = CycleClock::new(16_000_000);
        clock.cycles += 160;
        assert_eq!(clock.now(), 10 * US);
        clock.set_hz(168_000_000);
        clock.cycles += 168_000;
        assert_eq!(clock.now(), 1_010 * US);
    }

    #[test]
    fn an_instant_is_reached_at_its_cycle_and_not_before() {
        let mut clock = CycleClock::new(168_000_000);
        // 1 µs is 168 cycles exactly; one picosecond later needs the 169th.
        assert_eq!(clock.cycle_at(US), 168);
        assert_eq!(clock.cycle_at(US + 1), 169);
        clock.cycles = clock.cycle_at(12_345);
        assert!(clock.now() >= 12_345);
        clock.cycles -= 1;
        assert!(clock.now() < 12_345);
    }
}
