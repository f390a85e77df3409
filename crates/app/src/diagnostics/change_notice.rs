//! A value whose changes are worth a log line, but not a flood of them.

/// Least time between two lines about the same value: four a second.
const PAUSE_US: u64 = 250_000;

/// Remembers what was told last and when.
#[derive(Clone, Copy, Debug, Default)]
pub struct ChangeNotice<T> {
    told: T,
    silent_until_us: u64,
}

impl<T: Copy + PartialEq> ChangeNotice<T> {
    /// The value, if it must be told now. Call often: a change within the pause after the last line is told when the
    /// pause is over, if the value still differs from what was told.
    pub fn due(&mut self, value: T, now_us: u64) -> Option<T> {
        if value == self.told || now_us < self.silent_until_us {
            return None;
        }
        self.told = value;
        self.silent_until_us = now_us.saturating_add(PAUSE_US);
        Some(value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values every 10 ms; what was told, with its time in ms.
    fn told(values: impl Iterator<Item = u32>) -> Vec<(u64, u32)> {
        let mut notice = ChangeNotice::default();
        (0u64..)
            .step_by(10)
            .zip(values)
            .filter_map(|(ms, value)| Some((ms, notice.due(value, ms * 1_000)?)))
            .collect()
    }

    #[test]
    fn a_rare_change_is_told_at_once() {
        let values = (0..100).map(|step| u32::from(step >= 30) + u32::from(step >= 60));
        assert_eq!(told(values), [(300, 1), (600, 2)]);
    }

    #[test]
    fn a_flood_gives_four_lines_a_second_and_its_end_is_told() {
        let values = (0..300).map(|step: u32| step.min(112));
        let expected = [
            (10, 1),
            (260, 26),
            (510, 51),
            (760, 76),
            (1_010, 101),
            (1_260, 112),
        ];
        assert_eq!(told(values), expected);
    }

    #[test]
    fn a_change_that_is_undone_within_the_pause_is_not_told() {
        let values = (0..100).map(|step| match step {
            10..20 | 22 => 7,
            _ => 0,
        });
        assert_eq!(told(values), [(100, 7), (350, 0)]);
    }
}
