//! The stick and switch movement that starts bring-up: nobody makes it by accident.

use crate::domain::DriveMode;

/// From the first time the mode switch stands at its far end to the second.
const TIME_LIMIT_US: u64 = 4_000_000;

/// Where the mode switch has been, in this order. The middle does not count.
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

/// Mode switch from manual to custom and back and to custom again within 4 s, all the while with the `other_controls`
/// as they must be.
#[derive(Clone, Debug, Default)]
pub struct RadioGesture {
    progress: Progress,
}

impl RadioGesture {
    /// True once, in the call in which the gesture is complete.
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

    /// One call for each mode, `pause_ms` apart; the indices of the calls that completed it.
    fn completed(modes: &[DriveMode], pause_ms: u64) -> Vec<usize> {
        let mut gesture = RadioGesture::default();
        (0..modes.len())
            .filter(|&index| gesture.step(true, modes[index], index as u64 * pause_ms * 1_000))
            .collect()
    }

    #[test]
    fn twice_to_the_far_end_starts_once() {
        let modes = [Manual, Pc, Custom, Pc, Manual, Pc, Custom, Custom, Custom];
        assert_eq!(completed(&modes, 300), [6]);
    }

    #[test]
    fn it_must_begin_at_manual_and_go_back_there() {
        assert!(completed(&[Custom, Manual, Custom], 300).is_empty());
        assert!(completed(&[Manual, Custom, Pc, Custom], 300).is_empty());
    }

    #[test]
    fn too_slow_is_no_gesture() {
        assert_eq!(completed(&[Manual, Custom, Manual, Custom], 2_000), [3]);
        assert!(completed(&[Manual, Custom, Manual, Custom], 2_001).is_empty());
    }

    #[test]
    fn another_control_moved_meanwhile_starts_it_over() {
        let mut gesture = RadioGesture::default();
        let mut done = false;
        for (index, mode) in [Manual, Custom, Manual, Custom].into_iter().enumerate() {
            done |= gesture.step(index != 2, mode, index as u64 * 100_000);
        }
        assert!(!done);
    }
}
