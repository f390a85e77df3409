//! Pauses after consecutive failures: 1, 10, 60 and 300 s, and then 300 s each time.

const PAUSES_US: [u64; 4] = [1_000_000, 10_000_000, 60_000_000, 300_000_000];

#[derive(Clone, Copy, Debug, Default)]
pub struct BackOff {
    /// Failures since the last success. It saturates at the longest pause.
    failures: u8,
    until_us: u64,
}

impl BackOff {
    pub fn is_over(&self, now_us: u64) -> bool {
        now_us >= self.until_us
    }

    pub fn fail(&mut self, now_us: u64) {
        let [.., longest_us] = PAUSES_US;
        let pause = PAUSES_US.get(usize::from(self.failures));
        self.until_us = now_us.saturating_add(*pause.unwrap_or(&longest_us));
        if pause.is_some() {
            self.failures = self.failures.saturating_add(1);
        }
    }

    /// Extends the pause by a time in which no clock ran.
    pub fn extend(&mut self, by_us: u32) {
        self.until_us = self.until_us.saturating_add(u64::from(by_us));
    }

    pub fn succeed(&mut self) {
        *self = Self::default();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Times of the attempts in seconds, if each is made as soon as possible and fails.
    fn attempts_s(back_off: &mut BackOff, count: usize) -> Vec<u64> {
        let attempt_s = |second: &u64| {
            let due = back_off.is_over(second * 1_000_000);
            if due {
                back_off.fail(second * 1_000_000);
            }
            due
        };
        (0..10_000).filter(attempt_s).take(count).collect()
    }

    /// The pauses of docs/parameters.md.
    #[test]
    fn pauses_grow_to_a_maximum() {
        let mut back_off = BackOff::default();
        let times = attempts_s(&mut back_off, 7);
        assert_eq!(times, [0, 1, 11, 71, 371, 671, 971]);
    }

    #[test]
    fn a_stopped_clock_does_not_shorten_a_pause() {
        let mut back_off = BackOff::default();
        back_off.fail(0);
        back_off.extend(500_000);
        assert!(!back_off.is_over(1_499_999));
        assert!(back_off.is_over(1_500_000));
    }

    #[test]
    fn a_success_resets_the_pauses() {
        let mut back_off = BackOff::default();
        attempts_s(&mut back_off, 4);
        back_off.succeed();
        assert_eq!(attempts_s(&mut back_off, 3), [0, 1, 11]);
    }
}
