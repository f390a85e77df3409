//! Which field becomes the reference, and which is a disturbance.

use super::*;

const WINDOW_S: f32 = 0.2;
const TURNING_RPS: f32 = 1.0;
/// Central Europe: 49 µT, dip 66°.
const HOME: [f32; 2] = [20.0, -45.0];
/// 15 % stronger, with the same dip.
const STRONGER: [f32; 2] = [23.0, -51.75];

/// Feeds a field (horizontal, up) for some time. Returns whether it is disturbed at the end.
fn feed(
    detector: &mut DisturbanceDetector,
    [level, up]: [f32; 2],
    rate_rps: f32,
    seconds: f32,
) -> bool {
    let norm_ut = level.hypot(up);
    let windows = (seconds / WINDOW_S).round() as u32;
    (0..windows)
        .map(|_| detector.detect(norm_ut, up, rate_rps, WINDOW_S))
        .last()
        .expect("at least a window")
}

fn at_home() -> DisturbanceDetector {
    let mut detector = DisturbanceDetector::new();
    assert!(!feed(&mut detector, HOME, TURNING_RPS, 10.0));
    detector
}

#[test]
fn the_first_field_is_adopted_after_five_seconds_of_motion() {
    for (seconds, rate_rps, known) in [
        (4.6, TURNING_RPS, false),
        (5.6, TURNING_RPS, true),
        // Motion begins at 20 °/s.
        (60.0, 15.0_f32.to_radians(), false),
        (5.6, 25.0_f32.to_radians(), true),
    ] {
        let mut detector = DisturbanceDetector::new();
        assert!(!feed(&mut detector, HOME, rate_rps, seconds));
        // Without a reference no field is disturbed.
        let disturbed = feed(&mut detector, STRONGER, TURNING_RPS, WINDOW_S);
        assert_eq!(disturbed, known, "{seconds} s at {rate_rps} rad/s");
    }
}

#[test]
fn a_disturbance_starts_at_once_and_ends_after_half_a_second() {
    let steeper = [10.0, -48.3];
    let flatter = [29.0, -40.0];
    let weaker = [17.0, -38.25];
    for magnet in [STRONGER, weaker, steeper, flatter] {
        let mut detector = at_home();
        assert!(
            feed(&mut detector, magnet, TURNING_RPS, WINDOW_S),
            "{magnet:?}"
        );
        assert!(feed(&mut detector, HOME, TURNING_RPS, 0.4));
        assert!(!feed(&mut detector, HOME, TURNING_RPS, 0.4));
    }
}

#[test]
fn small_differences_are_the_same_field() {
    let mut detector = at_home();
    for near in [[21.5, -48.4], [18.5, -41.6], [24.0, -43.3], [16.0, -46.6]] {
        assert!(
            !feed(&mut detector, near, TURNING_RPS, WINDOW_S),
            "{near:?}"
        );
        feed(&mut detector, HOME, TURNING_RPS, 5.0);
    }
}

#[test]
fn another_reference_is_adopted_after_a_minute_of_motion() {
    let mut detector = at_home();
    assert!(feed(&mut detector, STRONGER, TURNING_RPS, 59.0));
    // Time at rest does not count.
    assert!(feed(&mut detector, STRONGER, 0.0, 300.0));
    assert!(!feed(&mut detector, STRONGER, TURNING_RPS, 2.0));
    // Now the stronger field is the reference.
    assert!(feed(&mut detector, HOME, TURNING_RPS, WINDOW_S));
}

#[test]
fn a_changing_field_never_becomes_the_reference() {
    let mut detector = at_home();
    for _ in 0..10 {
        assert!(feed(&mut detector, STRONGER, TURNING_RPS, 20.0));
        assert!(feed(&mut detector, [29.0, -40.0], TURNING_RPS, 20.0));
    }
}

#[test]
fn the_reference_follows_a_slow_change() {
    let mut detector = at_home();
    // 30 % in 5 minutes.
    for step in 0_u8..150 {
        let factor = 1.0 + 0.002 * f32::from(step);
        let field = HOME.map(|part| part * factor);
        assert!(!feed(&mut detector, field, 0.0, 2.0), "{step}");
    }
    assert!(feed(&mut detector, HOME, 0.0, WINDOW_S));
}
