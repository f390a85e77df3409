//! Unless a test says otherwise, all five frames of a sample are alike.

use super::*;
use crate::sensing::bmi088::decode_gyro;

const REST: [i16; 3] = [0, 0, 2_730];

struct Bench {
    plausibility: Plausibility,
    ts_us: u64,
}

impl Bench {
    /// After some samples at rest.
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

    /// Feeds a sample; returns whether it is marked as saturated.
    fn feed(&mut self, accel: [i16; 3], gyro: [i16; 3]) -> Result<bool, ImuSampleError> {
        self.feed_frames(accel, [gyro; 5])
            .map(|sample| sample.saturated)
    }

    fn feed_frames(
        &mut self,
        accel_counts: [i16; 3],
        frames: [[i16; 3]; 5],
    ) -> Result<PlausibleSample, ImuSampleError> {
        self.ts_us += 5_000;
        let accel = AccelRaw {
            counts: accel_counts,
            sensor_time: 0,
            temperature: None,
        };
        let bytes = frames.map(|frame| frame.map(i16::to_le_bytes));
        let mut answer = [0; 16];
        answer[1] = 0x0F;
        answer[3..9].copy_from_slice(bytes[4].as_flattened());
        answer[15] = 5;
        let bytes = bytes.as_flattened().as_flattened();
        let gyro = decode_gyro(&answer, bytes).expect("the chip id is there");
        self.plausibility.check(&accel, &gyro, self.ts_us)
    }
}

/// The full scale of ±2000 °/s is 32,767 counts. The robot spins up by 500 °/s a sample, stays out of range for 50 ms
/// and slows down again.
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

/// The rate reaches the end of its range and returns within two samples. No frame is lost.
#[test]
fn all_frames_of_an_impact_are_used() {
    let mut bench = Bench::new();
    let rates: [i16; 10] = [
        2_000,
        9_000,
        19_000,
        28_000,
        i16::MAX,
        i16::MAX,
        25_000,
        15_000,
        6_000,
        1_000,
    ];
    let frames = rates.map(|rate| [0, rate, 0]);
    let mut counts_ms = 0.0;
    let mut clipped_ms = 0;
    for read in [
        [frames[0], frames[1], frames[2], frames[3], frames[4]],
        [frames[5], frames[6], frames[7], frames[8], frames[9]],
    ] {
        let sample = bench.feed_frames(REST, read).expect("an impact");
        assert!(sample.saturated);
        counts_ms += 5.0 * sample.gyro.mean_counts[1];
        clipped_ms += sample.gyro.clipped_ms[1];
    }
    let sum: f32 = rates.into_iter().map(f32::from).sum();
    assert!((counts_ms - sum).abs() < 1.0, "{counts_ms} of {sum}");
    assert_eq!(clipped_ms, 2);
}

#[test]
fn an_impact_beyond_12_g_is_used_and_marked() {
    let mut bench = Bench::new();
    let samples = [[i16::MAX, 0, 9_000], [i16::MIN, 500, 2_000], REST];
    let verdicts = samples.map(|accel| bench.feed(accel, [200, 50, 10]));
    assert_eq!(verdicts, [Ok(true), Ok(true), Ok(false)]);
}

#[test]
fn a_sensor_that_stays_out_of_range_is_rejected() {
    for axis in [
        ([i16::MIN, 0, 0], [0; 3]),
        (REST, [0, i16::MAX, 0]),
        ([0, 0, i16::MAX], [i16::MIN, 0, 0]),
    ] {
        let mut bench = Bench::new();
        let (accel, gyro) = axis;
        // The rate rises in steps that a robot can make.
        for thirds in [1, 2] {
            let passed = bench.feed(REST, gyro.map(|count| count / 3 * thirds));
            assert_eq!(passed, Ok(false));
        }
        let accepted = (0..80)
            .take_while(|_| bench.feed(accel, gyro).is_ok())
            .count();
        assert_eq!(accepted, 40, "200 ms");
        let mut later = (0..200).map(|_| bench.feed(accel, gyro));
        assert!(later.all(|verdict| verdict == Err(ImuSampleError::Saturated)));
    }
}

/// Counts that jump between the ends of the range at random.
#[test]
fn no_random_sample_passes() {
    let mut bench = Bench::new();
    let mut state = 1u32;
    let mut extreme = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        [i16::MIN, i16::MAX, -32_767, 30_000][(state >> 30) as usize]
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
fn after_implausible_samples_only_unsaturated_ones_are_used() {
    let mut bench = Bench::new();
    for rate in [i16::MAX, i16::MIN, i16::MAX, i16::MIN, i16::MAX] {
        bench.feed(REST, [rate; 3]).unwrap_err();
    }
    for _ in 0..10 {
        let stuck = bench.feed(REST, [i16::MAX; 3]);
        assert_eq!(stuck, Err(ImuSampleError::Implausible));
    }
}

/// One bit flips on the bus: 500 °/s and more.
#[test]
fn an_outlier_costs_one_frame() {
    for bit in [13, 14, 15] {
        for place in 0..5 {
            let mut bench = Bench::new();
            let mut frames = [[3, -2, 1]; 5];
            frames[place][1] ^= 1 << bit;
            let verdicts = [
                bench.feed_frames(REST, frames),
                bench.feed_frames(REST, [[3, -2, 1]; 5]),
            ];
            let mut outliers = 0;
            for sample in verdicts {
                let sample = sample.expect("used");
                assert!(
                    (sample.gyro.mean_counts[1] + 2.0).abs() < 0.01,
                    "bit {bit} at {place}: {sample:?}"
                );
                outliers += sample.gyro.outliers;
            }
            assert_eq!(outliers, 1, "bit {bit} at {place}");
        }
    }
}

/// One or three samples in a row are wrong. The next good one is used at once.
#[test]
fn a_wrong_sample_costs_only_itself() {
    for times in [1, 3] {
        let mut bench = Bench::new();
        for _ in 0..times {
            let flipped = bench.feed(REST, [3, -2 ^ (1 << 15), 1]);
            assert_eq!(flipped, Err(ImuSampleError::Implausible));
        }
        assert_eq!(bench.feed(REST, [2, -1, 0]), Ok(false));
    }
}

#[test]
fn a_sensor_cannot_start_saturated() {
    let mut bench = Bench::new();
    bench.ts_us += 500_000;
    let woken = bench.feed(REST, [0, 0, i16::MIN]);
    assert_eq!(woken, Err(ImuSampleError::Implausible));

    let mut bench = Bench::new();
    bench.ts_us += 500_000;
    let turning = bench.feed(REST, [0, 0, 20_000]);
    assert_eq!(turning, Ok(false), "a gap hides how the rate came about");
}
