//! Impacts through a Butterworth low-pass, and outliers put among their frames.

use super::*;
use std::f64::consts::{PI, SQRT_2};

const COUNTS_PER_DPS: f64 = 16.384;
const READ: usize = 5;

/// Second-order Butterworth low-pass of 116 Hz in steps of 0.05 ms. Frames are taken every millisecond and saturate.
fn frames(rate_dps: impl Fn(f64) -> [f64; 3], ms: usize) -> Vec<Frame> {
    let (dt, omega) = (5e-5, 2.0 * PI * 116.0);
    let (mut y, mut slope) = ([0.0; 3], [0.0; 3]);
    (0..ms * 20)
        .filter_map(|step| {
            let x = rate_dps(step as f64 * dt);
            for axis in 0..3 {
                slope[axis] +=
                    dt * (omega * omega * (x[axis] - y[axis]) - SQRT_2 * omega * slope[axis]);
                y[axis] += dt * slope[axis];
            }
            (step % 20 == 19).then(|| y.map(|dps| (dps * COUNTS_PER_DPS).round() as i16))
        })
        .collect()
}

/// Sum of all rotation that was used, in counts · ms, and the number of outliers. `None` once a read is not plausible.
fn used_rotation(frames: &[Frame]) -> Option<([f64; 3], u8)> {
    let mut end = Some(SeriesEnd {
        measured: [0; 3],
        used: [0; 3],
    });
    let (mut sum, mut outliers) = ([0.0; 3], 0);
    for read in frames.chunks(READ) {
        let reading = GyroReading::from_frames(read, end)?;
        end = Some(reading.end);
        outliers += reading.outliers;
        for (sum, mean) in sum.iter_mut().zip(reading.mean_counts) {
            *sum += f64::from(mean) * read.len() as f64;
        }
    }
    Some((sum, outliers))
}

fn total(frames: &[Frame]) -> [f64; 3] {
    frames.iter().fold([0.0; 3], |sum, frame| {
        std::array::from_fn(|axis| sum[axis] + f64::from(frame[axis]))
    })
}

/// An impact of `peak_dps` that begins at `at_s`, as a step or half a sine.
fn impact(
    axis: usize,
    peak_dps: f64,
    ms: f64,
    abrupt: bool,
    at_s: f64,
) -> impl Fn(f64) -> [f64; 3] {
    move |t| {
        let share = (t - at_s) / (ms * 1e-3);
        let mut rate = [3.0, -2.0, 1.0];
        if (0.0..1.0).contains(&share) {
            rate[axis] += if abrupt {
                peak_dps
            } else {
                peak_dps * (PI * share).sin()
            };
        }
        rate
    }
}

#[test]
fn every_frame_of_an_impact_is_used() {
    for (case, peak_dps) in [400.0, 1_000.0, 1_900.0, -2_500.0, 3_500.0, -4_500.0]
        .into_iter()
        .enumerate()
    {
        for ms in [3.0, 10.0, 20.0, 60.0, 100.0] {
            for abrupt in [false, true] {
                // The impact begins anywhere within a read.
                let at_s = 0.02 + 0.000_7 * case as f64;
                let frames = frames(impact(case % 3, peak_dps, ms, abrupt, at_s), 150);
                let name = format!("{peak_dps} °/s for {ms} ms, abrupt: {abrupt}");
                let (sum, outliers) =
                    used_rotation(&frames).unwrap_or_else(|| panic!("{name}: implausible"));
                assert_eq!(outliers, 0, "{name}");
                for (sum, total) in sum.into_iter().zip(total(&frames)) {
                    assert!((sum - total).abs() < 1.0, "{name}: {sum} of {total}");
                }
            }
        }
    }
}

/// 3,200 °/s within 20 ms, more than any impact on a robot.
#[test]
fn two_opposite_impacts_are_used() {
    let rate = |t: f64| match (t * 1e3) as u32 {
        20..30 => [0.0, 1_600.0, 0.0],
        30..40 => [0.0, -1_600.0, 0.0],
        _ => [0.0; 3],
    };
    let frames = frames(rate, 80);
    let (sum, outliers) = used_rotation(&frames).expect("plausible");
    assert_eq!(outliers, 0);
    assert!((sum[1] - total(&frames)[1]).abs() < 1.0);
}

/// At rest and during an impact, anywhere in a read. During the impact the mean of the neighbours is off by less than
/// 0.4°.
#[test]
fn a_single_outlier_is_replaced_anywhere_in_a_read() {
    for peak_dps in [0.0, 1_500.0] {
        let good = frames(impact(1, peak_dps, 20.0, false, 0.02), 60);
        for place in 2..58 {
            for wrong in [
                [i16::MIN; 3],
                [i16::MAX, 0, 0],
                [0, 0, 16_384],
                [0, -32_000, 0],
            ] {
                let mut frames = good.clone();
                let before = frames[place];
                frames[place] =
                    std::array::from_fn(|axis| before[axis].saturating_add(wrong[axis]));
                let is_outlier =
                    (0..3).any(|axis| frames[place][axis].abs_diff(before[axis]) > 12_000);
                let Some((sum, outliers)) = used_rotation(&frames) else {
                    panic!("{wrong:?} at {place} spoils all");
                };
                if is_outlier {
                    assert_eq!(
                        outliers,
                        1,
                        "{wrong:?} at {place}: {:?}",
                        &frames[place - 2..place + 3]
                    );
                }
                for (sum, total) in sum.into_iter().zip(total(&good)) {
                    assert!(
                        (sum - total).abs() < 400.0 * COUNTS_PER_DPS,
                        "{wrong:?} at {place}: {sum} of {total}"
                    );
                }
            }
        }
    }
}

#[test]
fn jumps_and_two_outliers_make_a_read_implausible() {
    let rest: SeriesEnd = SeriesEnd {
        measured: [0; 3],
        used: [0; 3],
    };
    let read = |frames: [[i16; 3]; 5]| GyroReading::from_frames(&frames, Some(rest));
    let (quiet, wild) = ([1, 2, 3], [i16::MAX, 0, 0]);
    assert!(read([quiet; 5]).is_some());
    assert!(read([quiet, wild, wild, quiet, quiet]).is_none());
    assert!(read([wild; 5]).is_none());
    assert!(read([quiet, wild, quiet, wild, quiet]).is_none());
    assert!(read([quiet, wild, quiet, quiet, quiet]).is_some());
    assert!(GyroReading::from_frames(&[], None).is_none());
}

/// 26,000 counts in a millisecond are accepted, 26,001 are not.
#[test]
fn a_step_has_a_limit() {
    let frames = |step: i16| [[0; 3], [0, step, 0], [0, step, 0]];
    assert!(GyroReading::from_frames(&frames(26_000), None).is_some());
    assert!(GyroReading::from_frames(&frames(26_001), None).is_none());
}

/// By hand: two of five frames are at the end of y, one at that of z. A single frame stands for 5 ms.
#[test]
fn the_time_of_saturation_is_counted_by_axis() {
    let end = i16::MAX;
    let frames = [
        [0, 10_000, 0],
        [0, end, -20_000],
        [0, end, i16::MIN],
        [0, 25_000, -28_000],
        [0, 18_000, -21_000],
    ];
    let reading = GyroReading::from_frames(&frames, None).expect("plausible");
    assert_eq!(reading.clipped_ms, [0, 2, 1]);
    assert_eq!(reading.mean_counts[1], (2.0 * 32_767.0 + 53_000.0) / 5.0);
    let alone = GyroReading::from_frames(&[[0, -32_767, 0]], None).expect("plausible");
    assert_eq!(alone.clipped_ms, [0, 5, 0]);
}
