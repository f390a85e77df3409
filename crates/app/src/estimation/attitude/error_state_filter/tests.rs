//! The filter against a textbook Kalman filter with dense matrices in double precision, and its propagation of errors
//! against strapdown integration.

mod dense;
mod propagation;

use super::*;
use crate::{
    estimation::{
        attitude::error_state::{GYRO_PARAMETERS, STATES},
        strapdown::MidSample,
    },
    math::{
        Quaternion,
        testing::{rotation_of, to_f32},
    },
};
use robot_test_support::{Random, Rotation};

const DT_S: f32 = 0.005;
const GRAVITY_MPS2: f64 = 9.806_65;
/// A measurement with so much noise that it corrects nothing.
const IGNORED: Measurement = Measurement {
    innovation: 0.0,
    variance: 1e12,
};
const NO_MEASUREMENTS: Measurements = [Some(IGNORED), Some(IGNORED), None, None, None, None];

/// Angles, velocity, bias, misalignment.
fn state(correction: &Correction) -> [f64; STATES] {
    correction.errors.map(f64::from)
}

fn matrix(covariance: &Covariance) -> Vec<Vec<f64>> {
    let to_vec = |row: &ErrorVector| row.map(f64::from).to_vec();
    covariance.rows.iter().map(to_vec).collect()
}

/// Does all steps of one window. They must end before the next window is full.
fn finish(filter: &mut ErrorStateFilter) -> Correction {
    (0..40)
        .find_map(|_| filter.step().copied())
        .expect("a correction within 40 samples")
}

#[test]
fn an_invalid_covariance_is_reset_without_a_correction() {
    for broken in [-1.0, f32::NAN, f32::INFINITY] {
        let mut filter = ErrorStateFilter::new();
        filter.covariance.rows[3][3] = broken;
        filter.begin(&Window::new(), NO_MEASUREMENTS);
        // NaN and infinity are not valid. A negative variance may be raised to the least one instead.
        let corrections = (0..40).filter_map(|_| filter.step().copied());
        for correction in corrections {
            assert!(state(&correction).iter().all(|x| x.is_finite()), "{broken}");
        }
        let sound = matrix(&filter.covariance);
        assert!(
            (0..STATES).all(|i| sound[i][i] > 0.0 && sound[i].iter().all(|x| x.is_finite())),
            "{broken}: {sound:?}"
        );
    }
}
