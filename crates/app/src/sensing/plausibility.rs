//! Tells a sensor at its limits from one that talks nonsense.
//!
//! A robot can go beyond ±2000 °/s or ±12 g for a moment: such a sample is used and marked. It cannot change its turn
//! rate by 1000 °/s from one sample to the next, nor stay beyond the range, nor wake up there. After such a sample
//! nothing counts until a few quiet ones in a row.

use super::{
    ImuSampleError,
    bmi088::{AccelRaw, GyroRaw},
};
use crate::domain::age_us;

/// Full scale of both dies, and the code that no two's complement range has a twin of.
const FULL_SCALE: u16 = 32_767;
/// 1000 °/s: within 5 ms that is 3500 rad/s². The wildest of twelve motions recorded by hand (the BROAD trials) makes
/// 252 °/s.
const MAX_GYRO_STEP: u16 = 16_384;
/// Samples further apart than this are not compared.
const MAX_GAP_US: u32 = 20_000;
/// Samples in a row at the end of the range, 100 ms: as much as a blow or a spin may take.
const MAX_SATURATED: u8 = 20;
/// Plausible samples inside the range before a sensor that talked nonsense counts again.
const PROBATION: u8 = 4;

#[derive(Clone, Copy, Debug)]
struct LastSample {
    gyro_counts: [i16; 3],
    ts_us: u64,
}

/// Call [`judge`](Self::judge) with every sample that was read.
#[derive(Clone, Debug, Default)]
pub(super) struct Plausibility {
    last: Option<LastSample>,
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
        let gyro_saturated = is_saturated(gyro.counts);
        let saturated = gyro_saturated || is_saturated(accel.counts);
        let wild = match self.last {
            Some(last) if age_us(last.ts_us, ts_us) <= MAX_GAP_US => {
                is_wild(last.gyro_counts, gyro.counts)
            }
            _ => gyro_saturated,
        };
        self.last = Some(LastSample {
            gyro_counts: gyro.counts,
            ts_us,
        });
        self.saturated_in_row = if saturated {
            self.saturated_in_row.saturating_add(1)
        } else {
            0
        };
        if wild || (saturated && self.on_probation > 0) {
            self.on_probation = PROBATION;
            return Err(ImuSampleError::Implausible);
        }
        if self.saturated_in_row > MAX_SATURATED {
            self.on_probation = PROBATION;
            return Err(ImuSampleError::Saturated);
        }
        if self.on_probation > 0 {
            self.on_probation = self.on_probation.saturating_sub(1);
            return Err(ImuSampleError::Implausible);
        }
        Ok(saturated)
    }
}

fn is_saturated(counts: [i16; 3]) -> bool {
    counts
        .iter()
        .any(|count| count.unsigned_abs() >= FULL_SCALE)
}

fn is_wild(before: [i16; 3], now: [i16; 3]) -> bool {
    before
        .iter()
        .zip(now)
        .any(|(before, now)| now.abs_diff(*before) > MAX_GYRO_STEP)
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
            let gyro = GyroRaw {
                counts: gyro_counts,
            };
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
            for part in [3, 2] {
                let passed = bench.feed(REST, gyro.map(|count| count / part));
                assert_eq!(passed, Ok(false));
            }
            let accepted = (0..40)
                .take_while(|_| bench.feed(accel, gyro).is_ok())
                .count();
            assert_eq!(accepted, 20, "100 ms");
            assert!((0..200).all(|_| bench.feed(accel, gyro).is_err()));
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
        bench.feed(REST, [i16::MIN; 3]).unwrap_err();
        let back: Vec<bool> = (0..8)
            .map(|_| bench.feed(REST, [1, 2, 3]).is_ok())
            .collect();
        assert!(!back[3] && back[6], "{back:?}");
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
