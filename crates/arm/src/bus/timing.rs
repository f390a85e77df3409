//! How long an answer may take, and how often is asked.

use std::{collections::BTreeMap, time::Duration};

use super::frame::answer_size;

/// Start, eight data bits and stop.
const BITS_A_BYTE: u32 = 10;
/// That of a servo as shipped: 250 times 2 µs.
const SHIPPED_RETURN_DELAY: Duration = Duration::from_micros(500);

/// How often a question is asked, and what lies between.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Retries {
    /// Times that a question is asked, at the most; a servo that did not answer the question before is asked once.
    pub tries: u32,
    /// Pause before the second try. It doubles from try to try.
    pub first_pause: Duration,
    pub longest_pause: Duration,
}

impl Default for Retries {
    fn default() -> Self {
        Self {
            tries: 6,
            first_pause: Duration::from_micros(500),
            longest_pause: Duration::from_millis(8),
        }
    }
}

impl Retries {
    /// Pause before a try, of which the first has the number 0.
    pub(super) fn pause(&self, number: u32) -> Duration {
        let Some(doublings) = number.checked_sub(1) else {
            return Duration::ZERO;
        };
        let times = 2u32.saturating_pow(doublings);
        self.first_pause
            .saturating_mul(times)
            .min(self.longest_pause)
    }
}

/// What an answer's time is made of.
#[derive(Clone, Debug)]
pub(super) struct Timing {
    pub(super) bps: u32,
    /// What the computer and the adapter add. A driver of USB adapters may hold bytes back for 16 ms.
    pub(super) host_slack: Duration,
    return_delays: BTreeMap<u8, Duration>,
}

impl Timing {
    pub(super) fn new(bps: u32) -> Self {
        Self {
            bps,
            host_slack: Duration::from_millis(20),
            return_delays: BTreeMap::new(),
        }
    }

    /// Remembers a servo's register `return_delay`.
    pub(super) fn learn(&mut self, id: u8, register: i32) {
        let units = u64::try_from(register).unwrap_or_default();
        self.return_delays
            .insert(id, Duration::from_micros(2 * units));
    }

    pub(super) fn return_delay(&self, id: u8) -> Duration {
        self.return_delays
            .get(&id)
            .copied()
            .unwrap_or(SHIPPED_RETURN_DELAY)
    }

    /// Time of so many bytes on the line.
    pub(super) fn of_bytes(&self, bytes: usize) -> Duration {
        let bits = u64::try_from(bytes)
            .unwrap_or(u64::MAX)
            .saturating_mul(BITS_A_BYTE.into());
        Duration::from_nanos(bits.saturating_mul(1_000_000_000) / u64::from(self.bps.max(1)))
    }

    /// Time in which servos answer one after the other, with so many bytes of data each.
    pub(super) fn answers(&self, ids: &[u8], data: usize) -> Duration {
        let each = self.of_bytes(answer_size(data));
        ids.iter().map(|id| self.return_delay(*id) + each).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pauses_double_up_to_the_longest() {
        let retries = Retries::default();
        let pauses: Vec<_> = (0..8).map(|n| retries.pause(n).as_micros()).collect();
        assert_eq!(pauses, [0, 500, 1000, 2000, 4000, 8000, 8000, 8000]);
        assert_eq!(retries.pause(u32::MAX), retries.longest_pause);
    }

    /// Six answers of two bytes: 6 × 8 bytes at 10 µs.
    #[test]
    fn an_answer_takes_its_bytes_and_the_servos_own_delay() {
        let mut timing = Timing::new(1_000_000);
        let ids = [1, 2, 3, 4, 5, 6];
        assert_eq!(timing.answers(&ids, 2).as_micros(), 6 * (80 + 500));
        ids.iter().for_each(|id| timing.learn(*id, 0));
        assert_eq!(timing.answers(&ids, 2).as_micros(), 480);
        timing.bps = 115_200;
        assert_eq!(timing.of_bytes(8).as_nanos(), 694_444);
    }
}
