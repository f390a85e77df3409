//! Debouncing of conditions and limits.

/// Counts how long a condition has held.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Debounce {
    held_us: u32,
}

impl Debounce {
    /// Returns true once `active` has held for `hold_us` without a break. `dt_us` is the time since the last call.
    pub fn held(&mut self, active: bool, dt_us: u32, hold_us: u32) -> bool {
        self.held_us = if active {
            self.held_us.saturating_add(dt_us)
        } else {
            0
        };
        active && self.held_us >= hold_us
    }

    pub fn restart(&mut self) {
        self.held_us = 0;
    }
}

/// A limit with debouncing and hysteresis.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct DebouncedLimit {
    debounce: Debounce,
    exceeded: bool,
}

impl DebouncedLimit {
    /// Returns whether the limit is exceeded. `inside` tells whether the value is inside the limit tightened by the
    /// given margin; it must return false for NaN.
    pub fn step(
        &mut self,
        inside: impl Fn(f32) -> bool,
        margin: f32,
        dt_us: u32,
        hold_us: u32,
    ) -> bool {
        let held = self.debounce.held(!inside(0.0), dt_us, hold_us);
        self.exceeded = if self.exceeded { !inside(margin) } else { held };
        self.exceeded
    }
}
