//! What is done to the covariance from outside the filter.

use super::*;

/// Everything depends on everything.
fn full() -> Covariance {
    let mut covariance = Covariance::new();
    for (row, fast) in covariance.fast.iter_mut().enumerate() {
        for (column, entry) in fast.iter_mut().enumerate() {
            *entry += 1e-3 * (row + column) as f32;
        }
    }
    for (row, cross) in covariance.cross.iter_mut().enumerate() {
        for (column, entry) in cross.iter_mut().enumerate() {
            *entry = 1e-4 * (1 + row + 7 * column) as f32;
        }
    }
    for (row, slow) in covariance.slow.iter_mut().enumerate() {
        for (column, entry) in slow.iter_mut().enumerate() {
            *entry += 1e-5 * (1 + row + column) as f32;
        }
    }
    covariance
}

#[test]
fn a_new_bias_has_nothing_to_do_with_what_was_known() {
    let before = full();
    let mut after = before.clone();
    after.replace_bias(0.25);
    assert_eq!(after.bias_variances(), [0.25; 3]);
    for row in 0..FAST {
        assert_eq!(after.cross[row][..3], [0.0; 3]);
        assert_eq!(after.cross[row][3..], before.cross[row][3..]);
    }
    assert_eq!(after.fast, before.fast);
    for row in 0..PARAMETERS {
        for column in 0..PARAMETERS {
            let expected = match (row < 3, column < 3) {
                (false, false) => before.slow[row][column],
                _ if row == column => 0.25,
                _ => 0.0,
            };
            assert_eq!(after.slow[row][column], expected, "{row}, {column}");
        }
    }
}

#[test]
fn doubt_adds_to_the_angles_alone() {
    let before = full();
    let mut after = before.clone();
    after.doubt_angles([0.1, 0.2, 0.3]);
    for row in 0..FAST {
        for column in 0..FAST {
            let more = match (row, column) {
                (0, 0) => 0.1,
                (1, 1) => 0.2,
                (2, 2) => 0.3,
                _ => 0.0,
            };
            let expected = before.fast[row][column] + more;
            assert_eq!(after.fast[row][column], expected, "{row}, {column}");
        }
    }
    assert_eq!(after.slow, before.slow);
    assert_eq!(after.cross, before.cross);
}

#[test]
fn the_less_sure_of_both_level_axes_counts() {
    let mut covariance = Covariance::new();
    covariance.fast[0][0] = 1e-4;
    covariance.fast[1][1] = 3e-4;
    covariance.fast[2][2] = 2e-2;
    let Certainty { tilt, heading } = covariance.certainty();
    assert_eq!((tilt, heading), (3e-4, 2e-2));
    covariance.fast[0][0] = 5e-4;
    assert_eq!(covariance.certainty().tilt, 5e-4);
}
