//! Limits the rate of errors.

use crate::domain::SafetyConfig;

const LEAK_PERIOD_US: u64 = 100_000;
/// Upper limit of the level beyond the allowed one. It bounds the time that the flag outlasts a burst of errors to 2
/// s.
const MAX_EXCESS: u32 = 20;

/// A leaky bucket over a counter that only grows. It leaks ten errors a second.
#[derive(Clone, Debug, Default)]
pub(super) struct LeakyBucket {
    last_count: u32,
    level: u32,
    leaked_us: u64,
}

impl LeakyBucket {
    /// Returns whether the bucket holds more errors than the limit.
    pub fn exceeded(&mut self, errors: u32, config: &SafetyConfig, now_us: u64) -> bool {
        let limit = config.max_sensor_errors;
        let new_errors = errors.wrapping_sub(self.last_count);
        self.last_count = errors;
        let ceiling = limit.saturating_add(MAX_EXCESS);
        self.level = self.level.saturating_add(new_errors).min(ceiling);
        if now_us.saturating_sub(self.leaked_us) >= LEAK_PERIOD_US {
            self.leaked_us = now_us;
            self.level = self.level.saturating_sub(1);
        }
        self.level > limit
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The bucket leaks ten errors a second.
    #[test]
    fn errors_are_limited_to_ten_a_second() {
        let config = SafetyConfig::default();
        for (errors_per_s, trips) in [(5, false), (9, false), (11, true), (15, true)] {
            let mut bucket = LeakyBucket::default();
            let mut ticks = 1..60_000_u32;
            let tripped = ticks.any(|ms| {
                bucket.exceeded(ms * errors_per_s / 1_000, &config, u64::from(ms) * 1_000)
            });
            assert_eq!(tripped, trips, "{errors_per_s} a second");
        }
    }

    /// The limit is 20. One more error takes a tenth of a second to leak, and any larger number at most two seconds.
    #[test]
    fn a_burst_of_errors_leaks_away_within_two_seconds() {
        let config = SafetyConfig::default();
        for (errors, open_ms) in [(20, 0), (21, 100), (30, 1_000), (40, 2_000), (9_000, 2_000)] {
            let mut bucket = LeakyBucket::default();
            let storm_us = 600_000_000;
            assert!(!bucket.exceeded(0, &config, storm_us - 1));
            let mut times_ms = 0..10_000_u64;
            let closed_ms = times_ms
                .find(|ms| !bucket.exceeded(errors, &config, storm_us + ms * 1_000))
                .unwrap();
            assert!(closed_ms.abs_diff(open_ms) <= 1, "{errors}: {closed_ms} ms");
        }
    }
}
