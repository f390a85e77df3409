//! Changes to the covariance other than prediction and update.

use super::*;

/// A covariance in which all states are correlated.
fn full() -> Covariance {
    let mut covariance = Covariance::new();
    covariance.reset();
    for (row, entries) in covariance.rows.iter_mut().enumerate() {
        for (column, entry) in entries.iter_mut().enumerate() {
            *entry += 1e-5 * (1 + row + column) as f32;
        }
    }
    covariance
}

#[test]
fn a_reset_bias_is_not_correlated_with_other_states() {
    let before = full();
    let mut after = before.clone();
    after.reset_bias(0.25);
    assert_eq!(after.variances(BIAS), [0.25; 3]);
    let is_bias = |index: usize| (5..8).contains(&index);
    for row in 0..STATES {
        for column in 0..STATES {
            let expected = match is_bias(row) || is_bias(column) {
                false => before.rows[row][column],
                true if row == column => 0.25,
                true => 0.0,
            };
            assert_eq!(after.rows[row][column], expected, "{row}, {column}");
        }
    }
}

#[test]
fn added_variance_changes_only_its_states() {
    for first in [0, 2, 14] {
        let before = full();
        let mut after = before.clone();
        after.add_variances(first, &[0.1, 0.2, 0.3]);
        for row in 0..STATES {
            for column in 0..STATES {
                let more = match (row, column) {
                    _ if row != column => 0.0,
                    (row, _) if row == first => 0.1,
                    (row, _) if row == first + 1 => 0.2,
                    (row, _) if row == first + 2 => 0.3,
                    _ => 0.0,
                };
                let expected = before.rows[row][column] + more;
                assert_eq!(after.rows[row][column], expected, "{row}, {column}");
            }
        }
    }
}

#[test]
fn rounding_keeps_variances_positive() {
    let mut covariance = Covariance::new();
    covariance.add_bias_noise(0.0);
    assert_eq!(covariance.variances(BIAS), [1e-12; 3]);
}

#[test]
fn symmetrising_copies_the_rows_of_angles_and_speeds() {
    let mut covariance = full();
    for row in 0..BIAS {
        for column in row..STATES {
            covariance.rows[row][column] = (100 * row + column) as f32;
        }
    }
    let before = covariance.clone();
    covariance.symmetrise();
    for row in 0..STATES {
        for column in 0..STATES {
            let (least, other) = (row.min(column), row.max(column));
            let expected = if least < BIAS {
                (100 * least + other) as f32
            } else {
                before.rows[row][column]
            };
            assert_eq!(covariance.rows[row][column], expected, "{row}, {column}");
        }
    }
}

#[test]
fn tilt_variance_is_that_of_the_worse_axis() {
    let mut covariance = Covariance::new();
    covariance.rows[0][0] = 1e-4;
    covariance.rows[1][1] = 3e-4;
    covariance.rows[2][2] = 2e-2;
    let AttitudeVariance { tilt, heading } = covariance.attitude_variance();
    assert_eq!((tilt, heading), (3e-4, 2e-2));
    covariance.rows[0][0] = 5e-4;
    assert_eq!(covariance.attitude_variance().tilt, 5e-4);
}
