//! The gains of the velocity filter, against a Riccati recursion in double precision.

use super::super::velocity_filter::{FORWARD, Gains, LEFT, UP};

/// The gains of a covariance that is propagated at 200 Hz until it is stationary.
fn riccati(std_mps: f64, lasts_s: f64, wander_mps2: f64) -> [f64; 2] {
    let dt = 0.005;
    let (q, p, r) = (
        0.3 * 0.3 * dt,
        wander_mps2 * wander_mps2,
        2.0 * std_mps * std_mps * lasts_s,
    );
    let [mut vv, mut vb, mut bb] = [1.0, 0.0, 1.0];
    let mut gains = [0.0; 2];
    for _ in 0..200_000 {
        vv += -2.0 * vb * dt + bb * dt * dt + q * dt;
        vb -= bb * dt;
        bb += p * dt;
        // White noise of density r, averaged over one step.
        let innovation = vv + r / dt;
        gains = [vv / innovation, vb / innovation];
        bb -= vb * gains[1];
        vb -= vb * gains[0];
        vv -= vv * gains[0];
    }
    [gains[0] / dt, -gains[1] / dt]
}

#[test]
fn gains_are_the_stationary_ones_of_the_kalman_filter() {
    let check = |Gains { speed, bias }: Gains, expected: [f64; 2]| {
        for (got, expected) in [speed, bias].into_iter().zip(expected) {
            let ratio = f64::from(got) / expected;
            assert!((ratio - 1.0).abs() < 0.02, "{got} instead of {expected}");
        }
    };
    check(FORWARD, riccati(0.03, 0.05, 0.05));
    check(LEFT, riccati(0.05, 0.2, 0.05));
    check(UP, riccati(0.05, 0.2, 0.01));
}
