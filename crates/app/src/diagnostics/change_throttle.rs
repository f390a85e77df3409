//! Limits how often changes of a value are logged.

/// Shortest time between two lines about the same value: four lines a second.
const PAUSE_US: u64 = 250_000;

/// Remembers the value reported last, and when.
#[derive(Clone, Copy, Debug, Default)]
pub struct ChangeThrottle<T> {
    reported: T,
    paused_until_us: u64,
}

impl<T: Copy + PartialEq> ChangeThrottle<T> {
    /// Returns the value if it must be reported now; call it often. A change within the pause after a report is
    /// reported when the pause is over, if the value still differs.
    pub fn due(&mut self, value: T, now_us: u64) -> Option<T> {
        if value == self.reported || now_us < self.paused_until_us {
            return None;
        }
        self.reported = value;
        self.paused_until_us = now_us.saturating_add(PAUSE_US);
        Some(value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Takes values every 10 ms and returns the reported ones with their times in ms.
    fn reported(values: impl Iterator<Item = u32>) -> Vec<(u64, u32)> {
        let mut notice = ChangeThrottle::default();
        (0u64..)
            .step_by(10)
            .zip(values)
            .filter_map(|(ms, value)| Some((ms, notice.due(value, ms * 1_000)?)))
            .collect()
    }

    #[test]
    fn a_rare_change_is_reported_at_once() {
        let values = (0..100).map(|step| u32::from(step >= 30) + u32::from(step >= 60));
        assert_eq!(reported(values), [(300, 1), (600, 2)]);
    }

    #[test]
    fn frequent_changes_are_reported_four_times_a_second() {
        let values = (0..300).map(|step: u32| step.min(112));
        let expected = [
            (10, 1),
            (260, 26),
            (510, 51),
            (760, 76),
            (1_010, 101),
            (1_260, 112),
        ];
        assert_eq!(reported(values), expected);
    }

    #[test]
    fn a_change_undone_within_the_pause_is_not_reported() {
        let values = (0..100).map(|step| match step {
            10..20 | 22 => 7,
            _ => 0,
        });
        assert_eq!(reported(values), [(100, 7), (350, 0)]);
    }
}
