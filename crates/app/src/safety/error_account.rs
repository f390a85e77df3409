//! Counts errors that come faster than they are forgiven.

use crate::domain::SafetyConfig;

const FORGIVE_EVERY_US: u64 = 100_000;
/// Errors beyond the limit that are remembered: how long the flag stays after a storm (2 s).
const MEMORY: u32 = 20;

/// A leaky bucket over a counter that only grows.
#[derive(Clone, Debug, Default)]
pub(super) struct ErrorAccount {
    seen: u32,
    balance: u32,
    forgiven_us: u64,
}

impl ErrorAccount {
    /// True while more errors are open than the limit allows.
    pub fn exceeded(&mut self, errors: u32, config: &SafetyConfig, now_us: u64) -> bool {
        let limit = config.max_sensor_errors;
        let new_errors = errors.wrapping_sub(self.seen);
        self.seen = errors;
        let ceiling = limit.saturating_add(MEMORY);
        self.balance = self.balance.saturating_add(new_errors).min(ceiling);
        if now_us.saturating_sub(self.forgiven_us) >= FORGIVE_EVERY_US {
            self.forgiven_us = now_us;
            self.balance = self.balance.saturating_sub(1);
        }
        self.balance > limit
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rare_errors_are_forgiven_and_a_storm_is_not() {
        let config = SafetyConfig::default();
        let mut account = ErrorAccount::default();
        for second in 0..600u32 {
            assert!(!account.exceeded(second, &config, u64::from(second) * 1_000_000));
        }
        let storm_us = 600_000_000;
        assert!(account.exceeded(599 + 30, &config, storm_us));
        let mut cleared_us = 0;
        for step in 0..100 {
            let now_us = storm_us + step * 100_000;
            if !account.exceeded(599 + 30, &config, now_us) {
                cleared_us = now_us;
                break;
            }
        }
        // 30 errors, limit 20: at least nine rounds of forgiving.
        assert!((900_000..2_000_000).contains(&(cleared_us - storm_us)));
    }
}
