//! The output data rate of a die.

use crate::time::{Ps, SECOND};

/// Instants at which a die puts a new sample into its data registers.
#[derive(Clone, Copy, Debug)]
pub(super) struct SampleClock {
    period: Ps,
    next: Ps,
}

impl SampleClock {
    pub(super) fn new(rate_hz: f64, now: Ps) -> Self {
        let period = (SECOND as f64 / rate_hz).round() as Ps;
        Self {
            period,
            next: now + period,
        }
    }

    /// True when at least one instant has passed since the last call.
    pub(super) fn due(&mut self, now: Ps) -> bool {
        if now < self.next {
            return false;
        }
        let late = (now - self.next) / self.period;
        self.next += (late + 1) * self.period;
        true
    }
}
