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

    /// Ten a second are forgiven.
    #[test]
    fn errors_count_by_their_rate_in_ticks_of_a_millisecond() {
        let config = SafetyConfig::default();
        for (errors_per_s, trips) in [(5, false), (9, false), (11, true), (15, true)] {
            let mut account = ErrorAccount::default();
            let mut ticks = 1..60_000_u32;
            let tripped = ticks.any(|ms| {
                account.exceeded(ms * errors_per_s / 1_000, &config, u64::from(ms) * 1_000)
            });
            assert_eq!(tripped, trips, "{errors_per_s} a second");
        }
    }

    /// The limit is 20; one more is open for a tenth of a second, and however many more there are, for two.
    #[test]
    fn a_storm_counts_until_it_is_forgiven() {
        let config = SafetyConfig::default();
        for (errors, open_ms) in [(20, 0), (21, 100), (30, 1_000), (40, 2_000), (9_000, 2_000)] {
            let mut account = ErrorAccount::default();
            let storm_us = 600_000_000;
            assert!(!account.exceeded(0, &config, storm_us - 1));
            let mut times_ms = 0..10_000_u64;
            let closed_ms = times_ms
                .find(|ms| !account.exceeded(errors, &config, storm_us + ms * 1_000))
                .unwrap();
            assert!(closed_ms.abs_diff(open_ms) <= 1, "{errors}: {closed_ms} ms");
        }
    }
}
