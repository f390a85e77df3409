//! When a rest is detected, and what is no rest.

use super::*;
use core::f32::consts::TAU;
use robot_test_support::Random;

const GRAVITY: Vector3 = [0.0, 0.0, 9.806_65];
const SAMPLES: u8 = 40;
const DT_S: f32 = 0.005;
/// A horizontal strength of 20 µT.
const FIELD_UT: Vector3 = [0.0, 20.0, -45.0];

/// Number of the first window (from 1) that is a rest, or `None` within `windows`. The inputs are functions of time.
fn first_rest(
    windows: u16,
    gyro: impl Fn(f32) -> Vector3,
    accel: impl Fn(f32) -> Vector3,
    field: impl Fn(f32) -> Option<Vector3>,
) -> Option<u16> {
    let mut detector = RestDetector::default();
    let mut time_s = 0.0;
    (1..=windows).find(|_| {
        let middle_s = time_s + 0.5 * DT_S * f32::from(SAMPLES);
        for _ in 0..SAMPLES {
            time_s += DT_S;
            detector.feed(gyro(time_s), accel(time_s));
        }
        detector.close_window(field(middle_s)).is_some()
    })
}

fn still(_: f32) -> Vector3 {
    [0.01, -0.02, 0.005]
}

fn upright(_: f32) -> Vector3 {
    GRAVITY
}

/// The field in a body that rotates to the left.
fn turning_field(rate_rps: f32) -> impl Fn(f32) -> Option<Vector3> {
    let [_, level, up] = FIELD_UT;
    move |time_s| {
        let angle = rate_rps * time_s;
        Some([level * angle.sin(), level * angle.cos(), up])
    }
}

#[test]
fn rest_takes_seven_windows_or_twenty_with_a_magnetometer() {
    assert_eq!(first_rest(30, still, upright, |_| None), Some(7));
    assert_eq!(first_rest(30, still, upright, |_| Some(FIELD_UT)), Some(20));
}

#[test]
fn the_rate_at_rest_is_the_mean_of_the_window() {
    let mut detector = RestDetector::default();
    let mut found = None;
    for _ in 0..7 {
        for sample in 0..SAMPLES {
            let wobble = if sample % 2 == 0 { 0.01 } else { -0.01 };
            detector.feed([0.03 + wobble, -0.02, 0.01 - wobble], GRAVITY);
        }
        found = detector.close_window(None);
    }
    let [x, y, z] = found.expect("rest").rate_rps;
    assert!((x - 0.03).abs() < 1e-6 && (y + 0.02).abs() < 1e-6 && (z - 0.01).abs() < 1e-6);
}

/// The rotation is even, so only the field shows it.
#[test]
fn with_a_magnetometer_a_slow_rotation_is_no_rest() {
    for rate_dps in [-1.0_f32, -0.8, 0.8, 1.0, 3.0] {
        let rate_rps = rate_dps.to_radians();
        let gyro = |_: f32| [0.0, 0.0, rate_rps];
        let field = turning_field(rate_rps);
        assert_eq!(
            first_rest(600, gyro, upright, field),
            None,
            "{rate_dps} °/s"
        );
        assert_eq!(first_rest(30, gyro, upright, |_| None), Some(7));
    }
}

#[test]
fn noise_of_the_field_is_no_rotation() {
    let noise = core::cell::RefCell::new(Random::new(5));
    let field = |_: f32| {
        // The mean of ten samples with a noise of 0.3 µT.
        let [x, y, z] = noise.borrow_mut().vector(0.1).map(|x| x as f32);
        Some(vector::add(FIELD_UT, [x, y, z]))
    };
    assert_eq!(first_rest(30, still, upright, field), Some(20));
}

/// A rotation is as even as a bias. Without the field it would be taken for one from the 35th window on.
#[test]
fn a_rest_is_confirmed_in_seven_seconds_and_a_rotation_never() {
    let first_proof = |rate_dps: f32, level_ut: f32| {
        let rate_rps = rate_dps.to_radians();
        let mut detector = RestDetector::default();
        (1..=300_u16).find(|window| {
            for _ in 0..SAMPLES {
                detector.feed([0.0, 0.0, rate_rps], GRAVITY);
            }
            let angle = rate_rps * 0.2 * f32::from(*window);
            let field = [level_ut * angle.sin(), level_ut * angle.cos(), -45.0];
            detector
                .close_window(Some(field))
                .is_some_and(|rest| rest.confirmed)
        })
    };
    for rate_dps in [0.5, -0.7, 1.0, -2.0, 4.0] {
        for level_ut in [12.0, 20.0, 30.0] {
            assert_eq!(
                first_proof(rate_dps, level_ut),
                None,
                "{rate_dps} {level_ut}"
            );
        }
    }
    assert_eq!(first_proof(0.0, 20.0), Some(35));
}

/// The vibration of a motor at 50 Hz, as means over 5 ms.
fn vibration(amplitude: f32) -> impl Fn(f32) -> f32 {
    move |time_s| {
        let phase = |t: f32| (TAU * 50.0 * t).cos() / (TAU * 50.0);
        amplitude * (phase(time_s - DT_S) - phase(time_s)) / DT_S
    }
}

#[test]
fn slight_vibration_of_a_motor_is_still_rest() {
    let shaken = |amplitude: f32| {
        let wave = vibration(amplitude);
        move |time_s: f32| {
            let shake = wave(time_s);
            [shake, 0.0, 9.806_65]
        }
    };
    assert_eq!(first_rest(30, still, shaken(0.3), |_| None), Some(7));
    // A root mean square above 0.35 m/s² is no rest. The means over 5 ms show 0.90 of the amplitude.
    assert_eq!(first_rest(30, still, shaken(0.6), |_| None), None);
}

#[test]
fn vibration_of_the_gyro_is_no_rest() {
    let shaken = |amplitude_dps: f32| {
        let wave = vibration(amplitude_dps.to_radians());
        move |time_s: f32| [0.0, wave(time_s), 0.0]
    };
    assert_eq!(first_rest(30, shaken(1.0), upright, |_| None), Some(7));
    assert_eq!(first_rest(30, shaken(2.0), upright, |_| None), None);
}

#[test]
fn a_rest_at_another_attitude_is_a_new_rest() {
    // Quiet at all times, but with another attitude or rate from 1 s on.
    let tilted = |time_s: f32| {
        if time_s < 1.01 {
            GRAVITY
        } else {
            [0.5, 0.0, 9.79]
        }
    };
    assert_eq!(first_rest(30, still, tilted, |_| None), Some(5 + 7));
    let turning = |time_s: f32| {
        if time_s < 1.01 {
            [0.0; 3]
        } else {
            [0.0, 0.0, 0.6_f32.to_radians()]
        }
    };
    assert_eq!(first_rest(30, turning, upright, |_| None), Some(5 + 7));
}

/// Each window matches the one before but not the first.
#[test]
fn a_slow_drift_of_the_force_ends_the_rest() {
    let tilting = |time_s: f32| [9.806_65 * (0.02 * time_s).sin(), 0.0, 9.806_65];
    let first = first_rest(30, still, tilting, |_| None);
    assert_eq!(first, Some(7));
    let mut detector = RestDetector::default();
    let mut rests = 0;
    for window in 0_u16..60 {
        for _ in 0..SAMPLES {
            detector.feed([0.0; 3], tilting(0.2 * f32::from(window)));
        }
        if detector.close_window(None).is_some() {
            rests += 1;
        }
    }
    // The force has changed by 0.3 m/s² after 1.5 s, so one or two of every 8 windows are rest.
    assert!(rests < 20, "{rests} of 60");
}

#[test]
fn without_samples_there_is_no_rest() {
    let mut detector = RestDetector::default();
    assert!((0..50).all(|_| detector.close_window(Some(FIELD_UT)).is_none()));
}
