//! The counting part of a timer: prescaler, counter, auto-reload and compare, advanced lazily and exactly.
//!
//! Everything is counted in cycles of the timer's clock, so reading the counter often causes no drift.

/// Status flags (TIMx_SR) that an advance raised.
pub const UIF: u32 = 1;

/// CCxIF of channel 0–3.
pub const fn ccif(channel: usize) -> u32 {
    2 << channel
}

/// A register with an optional preload: `written` takes effect at an update event.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Shadowed {
    pub written: u32,
    pub active: u32,
}

impl Shadowed {
    pub fn load(&mut self) {
        self.active = self.written;
    }
}

#[derive(Debug)]
pub struct Counter {
    /// Largest count: 0xFFFF or 0xFFFF_FFFF.
    max: u32,
    pub enabled: bool,
    pub update_disabled: bool,
    pub one_pulse: bool,
    pub prescaler: Shadowed,
    pub reload: Shadowed,
    pub compare: [Shadowed; 4],
    count: u32,
    /// Clock cycles since the counter last stepped, below `prescaler.active + 1`.
    phase: u64,
    /// The cycle for which `count` and `phase` are valid.
    at: u64,
}

impl Counter {
    /// Reset values of a counter with 16 or 32 bits.
    pub fn new(max: u32) -> Self {
        Self {
            max,
            enabled: false,
            update_disabled: false,
            one_pulse: false,
            prescaler: Shadowed::default(),
            reload: Shadowed {
                written: max,
                active: max,
            },
            compare: [Shadowed::default(); 4],
            count: 0,
            phase: 0,
            at: 0,
        }
    }

    pub fn max(&self) -> u32 {
        self.max
    }

    /// TIMx_CNT as of the last advance.
    pub fn count(&self) -> u32 {
        self.count
    }

    pub fn set_count(&mut self, count: u32) {
        self.count = count;
    }

    /// Handles a change of clock. `cycle` of the old clock becomes cycle 0 of the new one.
    pub fn restart_cycles(&mut self) {
        self.at = 0;
    }

    /// Software update (EGR.UG): counter and prescaler cleared, preloads taken.
    pub fn update(&mut self) {
        self.count = 0;
        self.phase = 0;
        self.load();
    }

    fn load(&mut self) {
        self.prescaler.load();
        self.reload.load();
        for compare in &mut self.compare {
            compare.load();
        }
    }

    /// Counts up to `cycle` and returns the flags raised on the way.
    pub fn advance(&mut self, cycle: u64) -> u32 {
        let mut flags = 0;
        while self.running() && self.at + self.cycles_to_wrap() <= cycle {
            flags |= self.wrap();
            flags |= self.skip_whole_periods(cycle);
        }
        if self.running() {
            let elapsed = self.phase + (cycle - self.at);
            let step = self.step_cycles();
            let next = self.count + (elapsed / step) as u32;
            flags |= self.matches(u64::from(self.count) + 1, u64::from(next));
            self.count = next;
            self.phase = elapsed % step;
        }
        self.at = cycle;
        flags
    }

    /// The first cycle at which one of `flags` may be raised; `None` while the counter is stopped.
    pub fn next_flag(&self, flags: u32) -> Option<u64> {
        if !self.running() || flags == 0 {
            return None;
        }
        let ahead = (0..4)
            .filter(|n| flags & ccif(*n) != 0)
            .map(|n| u64::from(self.compare[n].active))
            .filter(|at| *at > u64::from(self.count) && *at < self.wrap_at())
            .min();
        Some(self.at + ahead.map_or_else(|| self.cycles_to_wrap(), |at| self.cycles_to(at)))
    }

    /// An auto-reload of 0 blocks the counter (RM0090 18.3.1).
    fn running(&self) -> bool {
        self.enabled && self.reload.active != 0
    }

    fn step_cycles(&self) -> u64 {
        u64::from(self.prescaler.active) + 1
    }

    /// The count after which the counter wraps to 0: the auto-reload value or, if already beyond it, the largest count.
    fn wrap_at(&self) -> u64 {
        let last = if self.count <= self.reload.active {
            self.reload.active
        } else {
            self.max
        };
        u64::from(last) + 1
    }

    fn cycles_to(&self, count: u64) -> u64 {
        (count - u64::from(self.count)) * self.step_cycles() - self.phase
    }

    fn cycles_to_wrap(&self) -> u64 {
        self.cycles_to(self.wrap_at())
    }

    fn wrap(&mut self) -> u32 {
        let overflow = self.count <= self.reload.active;
        let mut flags = self.matches(u64::from(self.count) + 1, self.wrap_at() - 1);
        self.at += self.cycles_to_wrap();
        self.count = 0;
        self.phase = 0;
        if overflow && !self.update_disabled {
            flags |= UIF;
            self.load();
        }
        if overflow && self.one_pulse {
            self.enabled = false;
        }
        flags | self.matches(0, 0)
    }

    /// Skips as many whole periods as fit before `cycle`, from the start of one.
    fn skip_whole_periods(&mut self, cycle: u64) -> u32 {
        if !self.running() {
            return 0;
        }
        let period = self.cycles_to_wrap();
        let whole = (cycle - self.at) / period;
        if whole == 0 {
            return 0;
        }
        self.at += whole * period;
        let update = if self.update_disabled { 0 } else { UIF };
        update | self.matches(0, u64::from(self.reload.active))
    }

    /// Flags of the channels whose compare value lies in `from..=to`.
    fn matches(&self, from: u64, to: u64) -> u32 {
        (0..4)
            .filter(|n| (from..=to).contains(&u64::from(self.compare[*n].active)))
            .fold(0, |flags, n| flags | ccif(n))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// PSC and ARR loaded, running from cycle 0.
    fn running(psc: u32, arr: u32, ccr: [u32; 2]) -> Counter {
        let mut counter = Counter::new(0xFFFF);
        counter.prescaler = Shadowed {
            written: psc,
            active: psc,
        };
        counter.reload = Shadowed {
            written: arr,
            active: arr,
        };
        for (compare, value) in counter.compare.iter_mut().zip(ccr) {
            *compare = Shadowed {
                written: value,
                active: value,
            };
        }
        counter.enabled = true;
        counter
    }

    #[test]
    fn overflow_comes_after_psc_plus_1_times_arr_plus_1_cycles() {
        // RM0090 18.3.2: update rate = clock / (PSC+1) / (ARR+1).
        let mut counter = running(83, 0xFFFF, [0x8000, 0]);
        assert_eq!(counter.next_flag(UIF), Some(84 * 65_536));
        assert_eq!(counter.next_flag(ccif(0)), Some(84 * 32_768));
        assert_eq!(counter.advance(84 * 32_768 - 1), 0);
        assert_eq!(counter.advance(84 * 32_768), ccif(0));
        assert_eq!(counter.count(), 0x8000);
        assert_eq!(counter.advance(84 * 65_536 - 1) & UIF, 0);
        assert_eq!(counter.advance(84 * 65_536) & UIF, UIF);
        assert_eq!(counter.count(), 0);
    }

    #[test]
    fn looking_often_does_not_change_the_count() {
        let (mut often, mut once) = (running(6, 999, [10, 20]), running(6, 999, [10, 20]));
        for cycle in 0..50_000 {
            often.advance(cycle);
        }
        once.advance(49_999);
        // 49 999 / 7 = 7142 steps = 7 periods of 1000 and 142.
        assert_eq!((often.count(), once.count()), (142, 142));
        assert_eq!(often.next_flag(UIF), once.next_flag(UIF));
    }

    #[test]
    fn a_reload_below_the_count_runs_to_the_end_of_the_counter() {
        let mut counter = running(0, 1000, [0, 0]);
        counter.advance(500);
        counter.reload.active = 400;
        assert_eq!(counter.next_flag(UIF), Some(65_536));
    }

    #[test]
    fn preloaded_values_wait_for_the_update() {
        let mut counter = running(0, 99, [50, 0]);
        counter.compare[0].written = 70;
        counter.prescaler.written = 1;
        assert_eq!(counter.next_flag(ccif(0)), Some(50));
        counter.advance(100);
        // Second period: two cycles a step.
        assert_eq!(counter.next_flag(ccif(0)), Some(100 + 2 * 70));
    }

    #[test]
    fn one_pulse_stops_at_the_overflow() {
        let mut counter = running(0, 9, [0, 0]);
        counter.one_pulse = true;
        assert_eq!(counter.advance(1_000) & UIF, UIF);
        assert_eq!((counter.count(), counter.enabled), (0, false));
    }
}
