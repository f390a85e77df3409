//! Tells a sensor at its limits from one that talks nonsense.
//!
//! A robot can go beyond ±2000 °/s or ±12 g for a moment: such a sample is used and marked. It cannot change its turn
//! rate by 1000 °/s from one sample to the next, nor stay beyond the range, nor wake up there. A wrong sample among good
//! ones costs that sample; when there has been no good one for a while, nothing counts until a few quiet ones in a row.

use super::{
    ImuSampleError,
    bmi088::{AccelRaw, GyroRaw},
};
use crate::domain::age_us;

/// Full scale of both dies, and the code that no two's complement range has a twin of.
const FULL_SCALE: u16 = 32_767;
/// 1000 °/s: within 5 ms that is 3500 rad/s². The wildest of twelve motions recorded by hand (the BROAD trials) makes
/// 252 °/s. A flip of either of the two upper bits is more.
const MAX_GYRO_STEP: u16 = 16_383;
/// Samples further apart than this are not compared.
const MAX_GAP_US: u32 = 20_000;
/// Samples in a row at the end of the range, 100 ms: as much as a blow or a spin may take.
const MAX_SATURATED: u8 = 20;
/// Plausible samples inside the range before a sensor that talked nonsense counts again.
const PROBATION: u8 = 4;

#[derive(Clone, Copy, Debug)]
struct GyroSample {
    counts: [i16; 3],
    ts_us: u64,
}

/// Call [`judge`](Self::judge) with every sample that was read.
#[derive(Clone, Debug, Default)]
pub(super) struct Plausibility {
    last: Option<GyroSample>,
    last_good: Option<GyroSample>,
    saturated_in_row: u8,
    on_probation: u8,
}

impl Plausibility {
    /// True if a sample that may be used has an axis at the end of its range.
    pub fn judge(
        &mut self,
        accel: &AccelRaw,
        gyro: &GyroRaw,
        ts_us: u64,
    ) -> Result<bool, ImuSampleError> {
        let sample = GyroSample {
            counts: gyro.counts,
            ts_us,
        };
        let saturated =
            is_saturated(gyro.lowest) || is_saturated(gyro.highest) || is_saturated(accel.counts);
        self.saturated_in_row = if saturated {
            self.saturated_in_row.saturating_add(1)
        } else {
            0
        };
        let before = self.last.replace(sample);
        if !is_steady(gyro) || !self.is_sane(&sample, before) {
            self.on_probation = PROBATION;
            return Err(ImuSampleError::Implausible);
        }
        if self.saturated_in_row > MAX_SATURATED {
            self.on_probation = PROBATION;
            return Err(ImuSampleError::Saturated);
        }
        if self.on_probation > 0 {
            self.on_probation = if saturated {
                PROBATION
            } else {
                self.on_probation.saturating_sub(1)
            };
            return Err(ImuSampleError::Implausible);
        }
        self.last_good = Some(sample);
        Ok(saturated)
    }

    fn is_sane(&mut self, sample: &GyroSample, before: Option<GyroSample>) -> bool {
        if let Some(good) = self.last_good.filter(|good| sample.comes_after(good)) {
            let sane = sample.can_follow(&good);
            if sane {
                self.on_probation = 0;
            }
            return sane;
        }
        match before.filter(|before| sample.comes_after(before)) {
            Some(before) => sample.can_follow(&before),
            None => !is_saturated(sample.counts),
        }
    }
}

impl GyroSample {
    fn comes_after(&self, other: &Self) -> bool {
        age_us(other.ts_us, self.ts_us) <= MAX_GAP_US
    }

    fn can_follow(&self, other: &Self) -> bool {
        self.counts
            .iter()
            .zip(other.counts)
            .all(|(now, before)| now.abs_diff(before) <= MAX_GYRO_STEP)
    }
}

/// What was measured since the last read fits together.
fn is_steady(gyro: &GyroRaw) -> bool {
    gyro.highest
        .iter()
        .zip(gyro.lowest)
        .all(|(highest, lowest)| highest.abs_diff(lowest) <= MAX_GYRO_STEP)
}

fn is_saturated(counts: [i16; 3]) -> bool {
    counts
        .iter()
        .any(|count| count.unsigned_abs() >= FULL_SCALE)
}

#[cfg(test)]
mod tests {
    use super::*;

    const REST: [i16; 3] = [0, 0, 2_730];

    struct Bench {
        plausibility: Plausibility,
        ts_us: u64,
    }

    impl Bench {
        /// At rest for a while.
        fn new() -> Self {
            let mut bench = Self {
                plausibility: Plausibility::default(),
                ts_us: 0,
            };
            for _ in 0..10 {
                assert_eq!(bench.feed(REST, [3, -2, 1]), Ok(false));
            }
            bench
        }

        fn feed(
            &mut self,
            accel_counts: [i16; 3],
            gyro_counts: [i16; 3],
        ) -> Result<bool, ImuSampleError> {
            self.ts_us += 5_000;
            let accel = AccelRaw {
                counts: accel_counts,
                sensor_time: 0,
                temperature: None,
            };
            let gyro = GyroRaw::of(gyro_counts);
            self.plausibility.judge(&accel, &gyro, self.ts_us)
        }
    }

    /// Full scale of ±2000 °/s is 32,767 counts: a spin-up at 500 °/s a sample that stays out of range for 50 ms.
    #[test]
    fn a_spin_beyond_the_range_for_a_moment_is_used_and_marked() {
        let mut bench = Bench::new();
        for rate in [8_000, 16_000, 24_000] {
            assert_eq!(bench.feed(REST, [0, 0, rate]), Ok(false));
        }
        for _ in 0..10 {
            assert_eq!(bench.feed(REST, [0, 0, i16::MAX]), Ok(true));
        }
        for rate in [24_000, 16_000, 8_000, 0] {
            assert_eq!(bench.feed(REST, [0, 0, rate]), Ok(false));
        }
    }

    #[test]
    fn a_blow_beyond_12_g_is_used_and_marked() {
        let mut bench = Bench::new();
        let samples = [[i16::MAX, 0, 9_000], [i16::MIN, 500, 2_000], REST];
        let verdicts = samples.map(|accel| bench.feed(accel, [200, 50, 10]));
        assert_eq!(verdicts, [Ok(true), Ok(true), Ok(false)]);
    }

    #[test]
    fn whoever_stays_out_of_range_is_not_believed() {
        for axis in [
            ([i16::MIN, 0, 0], [0; 3]),
            (REST, [0, i16::MAX, 0]),
            ([0, 0, i16::MAX], [i16::MIN, 0, 0]),
        ] {
            let mut bench = Bench::new();
            let (accel, gyro) = axis;
            // Up to the range in steps that a robot can make.
            for thirds in [1, 2] {
                let passed = bench.feed(REST, gyro.map(|count| count / 3 * thirds));
                assert_eq!(passed, Ok(false));
            }
            let accepted = (0..40)
                .take_while(|_| bench.feed(accel, gyro).is_ok())
                .count();
            assert_eq!(accepted, 20, "100 ms");
            let mut later = (0..200).map(|_| bench.feed(accel, gyro));
            assert!(later.all(|verdict| verdict == Err(ImuSampleError::Saturated)));
        }
    }

    /// Registers that jump among the ends of the range, by a generator of the test's own.
    #[test]
    fn of_nonsense_no_sample_passes() {
        let mut bench = Bench::new();
        let mut state = 1u32;
        let mut extreme = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            [i16::MIN, i16::MAX, -32_767, 20_000][(state >> 30) as usize]
        };
        for _ in 0..500 {
            let mut bench = Bench::new();
            for _ in 0..10 {
                let accel = [extreme(), extreme(), extreme()];
                let gyro = [extreme(), extreme(), extreme()];
                assert!(bench.feed(accel, gyro).is_err());
            }
        }
        for _ in 0..10 {
            bench.feed(REST, [extreme(); 3]).unwrap_err();
        }
        let back: Vec<bool> = (0..8)
            .map(|_| bench.feed(REST, [1, 2, 3]).is_ok())
            .collect();
        assert!(!back[3] && back[6], "{back:?}");
    }

    #[test]
    fn after_nonsense_only_samples_inside_the_range_count() {
        let mut bench = Bench::new();
        for rate in [i16::MAX, i16::MIN, i16::MAX, i16::MIN, i16::MAX] {
            bench.feed(REST, [rate; 3]).unwrap_err();
        }
        for _ in 0..10 {
            let stuck = bench.feed(REST, [i16::MAX; 3]);
            assert_eq!(stuck, Err(ImuSampleError::Implausible));
        }
    }

    /// A bit that flips on the wire, once or three times in a row.
    #[test]
    fn a_wrong_sample_among_good_ones_costs_that_sample_alone() {
        for (bit, times) in [(14, 1), (15, 1), (15, 3)] {
            let mut bench = Bench::new();
            for _ in 0..times {
                let flipped = bench.feed(REST, [3, -2 ^ (1 << bit), 1]);
                assert_eq!(flipped, Err(ImuSampleError::Implausible));
            }
            assert_eq!(bench.feed(REST, [2, -1, 0]), Ok(false));
        }
    }

    #[test]
    fn nobody_wakes_up_at_full_turn_rate() {
        let mut bench = Bench::new();
        bench.ts_us += 500_000;
        let woken = bench.feed(REST, [0, 0, i16::MIN]);
        assert_eq!(woken, Err(ImuSampleError::Implausible));

        let mut bench = Bench::new();
        bench.ts_us += 500_000;
        let turning = bench.feed(REST, [0, 0, 20_000]);
        assert_eq!(turning, Ok(false), "a gap hides how the rate came about");
    }
}
