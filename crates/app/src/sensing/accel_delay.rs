//! Delays the acceleration by as much as the angular rate is delayed.

use super::bmi088;
use crate::{
    domain::age_us,
    math::{Vector3, vector},
};

/// A sample that comes later than this after the last one is not interpolated.
const MAX_GAP_US: u32 = 7_500;

#[derive(Clone, Copy, Debug)]
struct Sample {
    accel_mps2: Vector3,
    saturated: bool,
    read_us: u64,
}

/// Interpolates between each sample and the one before, so that both stand for the same instant as the gyro's.
#[derive(Clone, Debug, Default)]
pub(super) struct AccelDelay {
    last: Option<Sample>,
}

impl AccelDelay {
    /// The acceleration at the instant that the rate read at `read_us` stands for, and whether either sample was
    /// saturated. Without a sample 5 ms before, the new one is returned as it is.
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

    /// The acceleration grows by 1 m/s² in 5 ms. The accelerometer is read 3.435 ms after the middle of its interval,
    /// the gyro 4.94 ms after it. The difference is 0.301 of 5 ms.
    #[test]
    fn a_steady_change_is_delayed_as_the_gyro_is() {
        let mut delay = AccelDelay::default();
        let (first, _) = delay.delay([10.0, 0.0, 0.0], false, 5_000);
        assert_eq!(first, [10.0, 0.0, 0.0]);
        let (second, _) = delay.delay([11.0, 0.0, 0.0], false, 10_000);
        assert!((second[0] - 10.699).abs() < 1e-3, "{second:?}");
    }

    #[test]
    fn a_pause_is_not_interpolated_and_a_saturated_sample_marks_the_next() {
        let mut delay = AccelDelay::default();
        delay.delay([118.0, 0.0, 0.0], true, 5_000);
        let (_, saturated) = delay.delay([11.0, 0.0, 0.0], false, 10_000);
        assert!(saturated);
        let (after, saturated) = delay.delay([12.0, 0.0, 0.0], false, 20_000);
        assert_eq!((after, saturated), ([12.0, 0.0, 0.0], false));
    }
}
