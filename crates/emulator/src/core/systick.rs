//! SysTick: the core's own 24-bit down-counter.

/// The programmed registers. The count is computed from the core's cycle counter.
#[derive(Debug, Default)]
pub struct SysTick {
    enabled: bool,
    interrupt: bool,
    /// CLKSOURCE: the core clock when set, an eighth of it when clear.
    core_clock: bool,
    reload: u32,
    /// Cycle at which the counter is zero and the present period begins.
    zero_at: u64,
    counted: bool,
}

const RELOAD_MAX: u32 = 0x00FF_FFFF;

impl SysTick {
    fn divider(&self) -> u64 {
        if self.core_clock { 1 } else { 8 }
    }

    fn period(&self) -> u64 {
        (u64::from(self.reload) + 1) * self.divider()
    }

    fn runs(&self) -> bool {
        self.enabled && self.reload != 0
    }

    /// Cycle of the next wrap to zero.
    pub fn next_cycle(&self) -> u64 {
        if self.runs() {
            self.zero_at + self.period()
        } else {
            u64::MAX
        }
    }

    /// Advances the counter to `cycles`. Returns true if an interrupt is due.
    pub fn run_due(&mut self, cycles: u64) -> bool {
        if self.next_cycle() > cycles {
            return false;
        }
        self.zero_at += (cycles - self.zero_at) / self.period() * self.period();
        self.counted = true;
        self.interrupt
    }

    /// Stops the counter while the core is halted for debugging.
    pub fn halted_for(&mut self, cycles: u64) {
        self.zero_at += cycles;
    }

    /// Reading CTRL clears COUNTFLAG.
    pub fn read_ctrl(&mut self) -> u32 {
        let counted = std::mem::take(&mut self.counted);
        u32::from(counted) << 16
            | u32::from(self.core_clock) << 2
            | u32::from(self.interrupt) << 1
            | u32::from(self.enabled)
    }

    pub fn write_ctrl(&mut self, value: u32, cycles: u64) {
        let was = self.enabled;
        self.enabled = value & 1 != 0;
        self.interrupt = value & 2 != 0;
        self.core_clock = value & 4 != 0;
        if self.enabled && !was {
            self.zero_at = cycles;
        }
    }

    pub fn reload(&self) -> u32 {
        self.reload
    }

    pub fn write_reload(&mut self, value: u32) {
        self.reload = value & RELOAD_MAX;
    }

    pub fn value(&self, cycles: u64) -> u32 {
        if !self.runs() {
            return 0;
        }
        let ticks = (cycles.saturating_sub(self.zero_at) % self.period()) / self.divider();
        if ticks == 0 {
            0
        } else {
            (u64::from(self.reload) + 1 - ticks) as u32
        }
    }

    /// Any write clears the counter and COUNTFLAG.
    pub fn write_value(&mut self, cycles: u64) {
        self.zero_at = cycles;
        self.counted = false;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wraps_every_reload_plus_one_cycles() {
        let mut tick = SysTick::default();
        tick.write_reload(999);
        tick.write_value(0);
        tick.write_ctrl(0b111, 500);
        assert_eq!(tick.next_cycle(), 1_500);
        assert!(!tick.run_due(1_499));
        assert!(tick.run_due(1_500));
        assert_eq!(tick.read_ctrl() >> 16 & 1, 1);
        assert_eq!(tick.read_ctrl() >> 16 & 1, 0);
        // One cycle after zero the counter holds the reload value.
        assert_eq!(tick.value(1_501), 999);
        assert_eq!(tick.next_cycle(), 2_500);
    }
}
