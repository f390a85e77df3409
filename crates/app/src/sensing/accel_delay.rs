//! Brings the acceleration to the instant the turn rate stands for.

use super::bmi088;
use crate::{
    domain::age_us,
    math::{Vector3, vector},
};

/// Samples further apart than this are not mixed.
const MAX_GAP_US: u32 = 7_500;

#[derive(Clone, Copy, Debug)]
struct Sample {
    accel_mps2: Vector3,
    saturated: bool,
    read_us: u64,
}

/// Mixes each sample with the one before, so that it is as late as the gyro's.
#[derive(Clone, Debug, Default)]
pub(super) struct AccelDelay {
    last: Option<Sample>,
}

impl AccelDelay {
    /// The acceleration that belongs to the turn rate read at `read_us`, and whether a part of it was at the end of the
    /// range. As it is where there is no sample 5 ms before.
    pub fn delay(&mut self, accel_mps2: Vector3, saturated: bool, read_us: u64) -> (Vector3, bool) {
        let last = self.last.replace(Sample {
            accel_mps2,
            saturated,
            read_us,
        });
        match last.filter(|last| age_us(last.read_us, read_us) <= MAX_GAP_US) {
            Some(last) => {
                let back = vector::sub(last.accel_mps2, accel_mps2);
                let mixed = vector::add(
                    accel_mps2,
                    vector::scale(back, bmi088::PREVIOUS_ACCEL_WEIGHT),
                );
                (mixed, saturated || last.saturated)
            }
            None => (accel_mps2, saturated),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An acceleration that grows by 1 m/s² in 5 ms, read 3.435 ms after the middle of what it shows, is brought to
    /// 4.94 ms: 0.301 of 5 ms earlier.
    #[test]
    fn a_steady_change_is_shown_as_late_as_the_gyro_shows_it() {
        let mut delay = AccelDelay::default();
        let (first, _) = delay.delay([10.0, 0.0, 0.0], false, 5_000);
        assert_eq!(first, [10.0, 0.0, 0.0]);
        let (second, _) = delay.delay([11.0, 0.0, 0.0], false, 10_000);
        assert!((second[0] - 10.699).abs() < 1e-3, "{second:?}");
    }

    #[test]
    fn a_pause_is_not_mixed_and_a_cut_off_sample_marks_the_next() {
        let mut delay = AccelDelay::default();
        delay.delay([118.0, 0.0, 0.0], true, 5_000);
        let (_, saturated) = delay.delay([11.0, 0.0, 0.0], false, 10_000);
        assert!(saturated);
        let (after, saturated) = delay.delay([12.0, 0.0, 0.0], false, 20_000);
        assert_eq!((after, saturated), ([12.0, 0.0, 0.0], false));
    }
}
