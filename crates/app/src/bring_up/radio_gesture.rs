//! The stick and switch gesture that starts bring-up. It cannot be made by accident.

use crate::domain::DriveMode;

/// Time from the first position at custom to the second.
const TIME_LIMIT_US: u64 = 4_000_000;

/// Positions of the mode switch so far, in this order. The middle does not count.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Progress {
    #[default]
    Nothing,
    Near,
    Far {
        since_us: u64,
    },
    NearAgain {
        since_us: u64,
    },
}

/// Detects the mode switch going from manual to custom, back, and to custom again within 4 s, while the
/// `other_controls` are in place.
#[derive(Clone, Debug, Default)]
pub struct RadioGesture {
    progress: Progress,
}

impl RadioGesture {
    /// Returns true once, when the gesture is complete.
    pub fn step(&mut self, other_controls: bool, mode: DriveMode, now_us: u64) -> bool {
        if !other_controls || self.too_slow(now_us) {
            self.progress = Progress::Nothing;
            return false;
        }
        self.progress = match (self.progress, mode) {
            (Progress::Nothing, DriveMode::Manual) => Progress::Near,
            (Progress::Near, DriveMode::Custom) => Progress::Far { since_us: now_us },
            (Progress::Far { since_us }, DriveMode::Manual) => Progress::NearAgain { since_us },
            (Progress::NearAgain { .. }, DriveMode::Custom) => {
                self.progress = Progress::Nothing;
                return true;
            }
            (unchanged, _) => unchanged,
        };
        false
    }

    fn too_slow(&self, now_us: u64) -> bool {
        match self.progress {
            Progress::Nothing | Progress::Near => false,
            Progress::Far { since_us } | Progress::NearAgain { since_us } => {
                now_us.saturating_sub(since_us) > TIME_LIMIT_US
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use DriveMode::{Custom, Manual, Pc};

    /// Makes one call for each mode, `pause_ms` apart, and returns the indices of the calls that completed the
    /// gesture.
    fn completed(modes: &[DriveMode], pause_ms: u64) -> Vec<usize> {
        let mut gesture = RadioGesture::default();
        (0..modes.len())
            .filter(|&index| gesture.step(true, modes[index], index as u64 * pause_ms * 1_000))
            .collect()
    }

    #[test]
    fn two_moves_to_the_far_end_start_bring_up_once() {
        let modes = [Manual, Pc, Custom, Pc, Manual, Pc, Custom, Custom, Custom];
        assert_eq!(completed(&modes, 300), [6]);
    }

    #[test]
    fn the_gesture_begins_at_manual_and_returns_there() {
        assert!(completed(&[Custom, Manual, Custom], 300).is_empty());
        assert!(completed(&[Manual, Custom, Pc, Custom], 300).is_empty());
    }

    #[test]
    fn a_slow_gesture_does_not_count() {
        assert_eq!(completed(&[Manual, Custom, Manual, Custom], 2_000), [3]);
        assert!(completed(&[Manual, Custom, Manual, Custom], 2_001).is_empty());
    }

    #[test]
    fn moving_another_control_restarts_the_gesture() {
        let mut gesture = RadioGesture::default();
        let mut done = false;
        for (index, mode) in [Manual, Custom, Manual, Custom].into_iter().enumerate() {
            done |= gesture.step(index != 2, mode, index as u64 * 100_000);
        }
        assert!(!done);
    }
}
