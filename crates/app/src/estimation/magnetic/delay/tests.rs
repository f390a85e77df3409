//! A delayed magnetometer on a robot whose attitude is known exactly.

use super::*;
use crate::math::testing::to_f32;
use robot_test_support::{Random, Rotation};

const EARTH_UT: [f64; 3] = [0.0, 20.0, -45.0];

/// Rotates back and forth, and tilts.
fn moving(t: f64) -> Rotation {
    Rotation::by([0.0, 0.0, 3.0 * (0.8 * t).sin()]).then_in_body(Rotation::by([
        0.5 * (1.7 * t).sin(),
        0.0,
        0.0,
    ]))
}

/// The delay found after some time at 50 Hz. The true delay beyond the time stamps is `late_s`.
fn found_s(late_s: f64, seconds: f64, noise_ut: f64, attitude: impl Fn(f64) -> Rotation) -> f64 {
    let mut delay = DelayFilter::new();
    let mut random = Random::new(21);
    let samples = (seconds * 50.0).round() as u32;
    for sample in 0..samples {
        let t = 1.0 + f64::from(sample) * 0.02;
        let seen = attitude(t - late_s).seen_from_body(EARTH_UT);
        let noise = random.vector(noise_ut);
        let seen = std::array::from_fn(|axis| seen[axis] + noise[axis]);
        let estimated = attitude(t - f64::from(delay.seconds()));
        let step = 1e-4;
        let rate = estimated
            .to(attitude(t - f64::from(delay.seconds()) + step))
            .map(|angle| angle / step);
        delay.update(to_f32(estimated.turn(seen)), to_f32(rate));
        assert!((0.0..=MAX_DELAY_S).contains(&delay.seconds()));
    }
    f64::from(delay.seconds())
}

#[test]
fn a_delay_is_found_in_motion() {
    for late_s in [0.0, 0.005, 0.015, 0.030] {
        let found = found_s(late_s, 120.0, 0.5, moving);
        println!("{} ms: {:.2} ms", 1e3 * late_s, 1e3 * found);
        // The prior of 0 ± 10 ms holds the estimate back by an eighth.
        assert!(
            (found - late_s).abs() < 0.000_5 + late_s / 8.0,
            "{late_s}: {found}"
        );
    }
}

#[test]
fn without_motion_there_is_no_delay() {
    let found = found_s(0.015, 600.0, 1.0, |_| Rotation::by([0.1, -0.2, 0.7]));
    assert!(found < 0.000_1, "{found}");
}

#[test]
fn a_delay_stays_within_its_limits() {
    let found = found_s(0.2, 120.0, 0.5, moving);
    assert!((0.04..0.050_001).contains(&found), "{found}");
    // The samples are newer than their time stamps.
    assert!(found_s(-0.02, 120.0, 0.5, moving) < 0.002);
}

/// The innovation of 40 µT fails the gate.
#[test]
fn a_disturbance_is_no_delay() {
    let mut delay = DelayFilter::new();
    let rate_rps = [0.0, 0.0, 2.0];
    for _ in 0..500 {
        delay.update([0.0, 20.0, -45.0], rate_rps);
    }
    for _ in 0..100 {
        delay.update([-40.0, 20.0, -45.0], rate_rps);
    }
    assert_eq!(delay.seconds(), 0.0);
}

/// A delayed field seems to rotate with the robot: to the left in a rotation to the left.
#[test]
fn the_sign_of_the_delay_is_right() {
    for (rate, east_ut) in [(2.0, -0.6), (-2.0, 0.6)] {
        let mut delay = DelayFilter::new();
        for _ in 0..200 {
            delay.update([0.0, 20.0, -45.0], [0.0; 3]);
        }
        for _ in 0..50 {
            delay.update([east_ut, 20.0, -45.0], [0.0, 0.0, rate]);
        }
        assert!(delay.seconds() > 0.000_5, "{}", delay.seconds());
        let mut other = DelayFilter::new();
        for _ in 0..200 {
            other.update([0.0, 20.0, -45.0], [0.0; 3]);
        }
        for _ in 0..50 {
            other.update([-east_ut, 20.0, -45.0], [0.0, 0.0, rate]);
        }
        assert_eq!(other.seconds(), 0.0);
    }
}

#[test]
fn a_rotation_of_the_world_rotates_the_reference() {
    let mut delay = DelayFilter::new();
    for _ in 0..1_000 {
        delay.update([0.0, 20.0, -45.0], [0.0; 3]);
    }
    // The heading is corrected by 0.1 rad to the left, so the same field now lies there.
    delay.rotate_world([0.0, 0.0, 0.1]);
    for _ in 0..200 {
        delay.update([-2.0, 20.0, -45.0], [0.0, 0.0, 5.0]);
    }
    assert!(delay.seconds() < 1e-4, "{}", delay.seconds());
    delay.reset_reference();
    for _ in 0..50 {
        delay.update([2.0, 20.0, -45.0], [0.0, 0.0, 5.0]);
    }
    assert!(delay.seconds() < 1e-4, "{}", delay.seconds());
}
