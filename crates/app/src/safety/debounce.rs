//! A condition that counts only when it has held for a while.

/// How long a condition has held.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Debounce {
    held_us: u32,
}

impl Debounce {
    /// True once `active` held for `hold_us` without a break; `dt_us` has passed since the last call.
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

/// A value beyond its limit for a while; back only when it is well inside again.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Excess {
    debounce: Debounce,
    exceeded: bool,
}

impl Excess {
    /// `inside` tells whether the value is inside a limit that is tightened by the given margin. Anything it does not
    /// confirm, such as NaN, is outside.
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
