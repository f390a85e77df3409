//! Resamples a recording from 285.7 to 200 Hz.
//!
//! Sample k of the dataset covers the 3.5 ms that end at k · 3.5 ms. Row j of a trial has the mean over the 5 ms that
//! end at j · 5 ms, and the reference at that instant.

use robot_plant::attitude;

use super::source::Recorded;

/// Length of a sample and of a row, in units of 0.5 ms.
const SAMPLE: usize = 7;
const ROW: usize = 10;
const ROW_S: f64 = 0.005;

/// Names of the columns.
pub(super) const NAMES: [&str; 18] = [
    "t", "gx", "gy", "gz", "ax", "ay", "az", "mx", "my", "mz", "qw", "qx", "qy", "qz", "mov", "px",
    "py", "pz",
];

/// Returns the columns of the trial, in the order of [`NAMES`].
pub(super) fn columns(recorded: &Recorded) -> Vec<Vec<f32>> {
    let last = recorded.gyro_rps.len() - 1;
    let mut columns = vec![Vec::new(); NAMES.len()];
    for row in 0..=last * SAMPLE / ROW {
        let (gyro, accel) = (
            mean(&recorded.gyro_rps, row),
            mean(&recorded.accel_mps2, row),
        );
        let field = mean(&recorded.field_ut, row);
        let [qw, qx, qy, qz] = reference(&recorded.reference_wxyz, row);
        let position = between(&recorded.position_m, row);
        let moving = recorded.moving[nearest(row).min(last)];
        let values = [
            row as f64 * ROW_S,
            gyro[0],
            gyro[1],
            gyro[2],
            accel[0],
            accel[1],
            accel[2],
            field[0],
            field[1],
            field[2],
            qw,
            qx,
            qy,
            qz,
            f64::from(u8::from(moving)),
            position[0],
            position[1],
            position[2],
        ];
        for (column, value) in columns.iter_mut().zip(values) {
            column.push(value as f32);
        }
    }
    columns
}

/// Returns the mean over a row. A sample is weighted by the time that it shares with the row. There is nothing before
/// sample 0, so row 0 is sample 0.
fn mean(samples: &[[f64; 3]], row: usize) -> [f64; 3] {
    // Both count from the start of sample 0.
    let end = row * ROW + SAMPLE;
    let start = end.saturating_sub(ROW);
    let mut sum = [0.0; 3];
    let mut covered = 0.0;
    let first = start / SAMPLE;
    for (index, sample) in samples
        .iter()
        .enumerate()
        .take(end.div_ceil(SAMPLE))
        .skip(first)
    {
        let share = end.min((index + 1) * SAMPLE) - start.max(index * SAMPLE);
        covered += share as f64;
        for (sum, value) in sum.iter_mut().zip(sample) {
            *sum += share as f64 * value;
        }
    }
    sum.map(|sum| sum / covered)
}

/// Returns the sample at or before the end of the row, and how far the row reaches towards the next one, from 0 to 1.
fn place(row: usize) -> (usize, f64) {
    let at = row * ROW;
    (at / SAMPLE, (at % SAMPLE) as f64 / SAMPLE as f64)
}

fn nearest(row: usize) -> usize {
    (row * ROW + SAMPLE / 2) / SAMPLE
}

/// Returns the reference at the end of a row, or NaN where a neighbour is not known.
fn reference(samples: &[[f64; 4]], row: usize) -> [f64; 4] {
    let (index, share) = place(row);
    let attitude = if share == 0.0 {
        attitude::normalised(samples[index])
    } else {
        attitude::between(samples[index], samples[index + 1], share)
    };
    attitude.unwrap_or([f64::NAN; 4])
}

fn between(samples: &[[f64; 3]], row: usize) -> [f64; 3] {
    let (index, share) = place(row);
    if share == 0.0 {
        return samples[index];
    }
    let next = samples[index + 1];
    std::array::from_fn(|axis| (1.0 - share) * samples[index][axis] + share * next[axis])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Eleven samples of 3.5 ms end at 35 ms and give eight rows. The row from 0 to 5 ms is all of sample 1 and 1.5 ms
    /// of sample 2.
    fn counting() -> Recorded {
        let row = |k: usize| [k as f64; 3];
        let samples: Vec<[f64; 3]> = (0..11).map(row).collect();
        let attitude = |k: usize| match k {
            4 => [f64::NAN; 4],
            _ => [1.0, 0.0, 0.0, 0.0],
        };
        Recorded {
            gyro_rps: samples.clone(),
            accel_mps2: samples.clone(),
            field_ut: samples.clone(),
            reference_wxyz: (0..11).map(attitude).collect(),
            position_m: samples,
            moving: (0..11).map(|k| k >= 3).collect(),
        }
    }

    fn column(name: &str) -> Vec<f32> {
        let place = NAMES.iter().position(|known| *known == name).unwrap();
        columns(&counting()).swap_remove(place)
    }

    #[test]
    fn a_row_is_the_mean_over_its_5_ms() {
        let gx = column("gx");
        assert_eq!(gx.len(), 8);
        assert_eq!(gx[0], 0.0);
        assert!((gx[1] - (3.5 * 1.0 + 1.5 * 2.0) / 5.0).abs() < 1e-6);
        assert!((gx[7] - (1.5 * 9.0 + 3.5 * 10.0) / 5.0).abs() < 1e-6);
        assert_eq!(column("t")[7], 0.035);
    }

    /// Row 3 ends at 15 ms, between sample 4, which is not known, and sample 5.
    #[test]
    fn the_reference_is_interpolated_but_not_across_a_gap() {
        let unknown: Vec<bool> = column("qw").iter().map(|w| w.is_nan()).collect();
        let expected = [false, false, false, true, false, false, false, false];
        assert_eq!(unknown, expected);
        assert!((column("px")[1] - 10.0 / 7.0).abs() < 1e-6);
        // Sample 3 ends at 10.5 ms, nearest to row 2.
        assert_eq!(column("mov")[..3], [0.0, 0.0, 1.0]);
    }
}
