//! Impacts within the gyro's range and beyond it, through the models of the board's sensors, the sensing stage and the
//! estimator. How soon is the tilt known again, and does `valid` tell?
//!
//! The motion is simulated in double precision (`motion`). The robot is hit while it stands, turns or drives. Each test
//! takes a few random impacts; `--ignored` takes hundreds.

#[path = "../recorded_through_sensors/board.rs"]
mod board;
mod motion;
mod record;
mod run;

use motion::{Base, Impact};
use robot_test_support::{Random, Vector};
use run::Outcome;

const FEW: u64 = 8;
const MANY: u64 = 150;
const STANDING: [Base; 2] = [Base::Standing, Base::Turning { dps: 60 }];
const DRIVING: [Base; 1] = [Base::Driving];
/// Impacts that tilt the robot further than this are left out, °.
const MOST_DEG: f64 = 90.0;

/// A random impact of 10 to 100 ms about any axis, with a peak between these rates in °/s.
fn any_impact(noise: &mut Random, at_s: f64, from_dps: f64, to_dps: f64) -> Impact {
    loop {
        let abrupt = noise.unit() < 0.5;
        let peak_dps = noise.between(from_dps, to_dps);
        let ms = noise.between(10.0, 100.0);
        let turn_deg = peak_dps
            * ms
            * 1e-3
            * if abrupt {
                1.0
            } else {
                2.0 / std::f64::consts::PI
            };
        if turn_deg > MOST_DEG {
            continue;
        }
        return Impact {
            at_s: at_s + noise.between(0.0, 0.2),
            axis: direction(noise),
            peak_dps,
            ms,
            abrupt,
            accel_mps2: robot_test_support::scale(direction(noise), push_mps2(noise, ms)),
        };
    }
}

/// An acceleration up to the accelerometer's range and beyond, or one that makes the robot 2 m/s faster.
fn push_mps2(noise: &mut Random, ms: f64) -> f64 {
    if noise.unit() < 0.5 {
        return noise.between(80.0, 400.0);
    }
    noise.between(0.0, 2.0) / (ms * 1e-3)
}

/// Half of the impacts are along an axis of the body, as on real robots.
fn direction(noise: &mut Random) -> Vector {
    let mut vector = [0.0; 3];
    if noise.unit() < 0.5 {
        let axis = noise.below(3);
        vector[axis] = if noise.unit() < 0.5 { -1.0 } else { 1.0 };
        return vector;
    }
    let drawn = noise.vector(1.0);
    let length = drawn.iter().map(|part| part * part).sum::<f64>().sqrt();
    robot_test_support::scale(drawn, 1.0 / length.max(1e-6))
}

/// Asserts what is required of each impact, and prints the worst.
fn hold(
    name: &str,
    bases: &[Base],
    count: u64,
    impacts: impl Fn(&mut Random) -> Vec<Impact>,
    wanted: impl Fn(Base, &Outcome) -> bool,
) {
    let mut worst: Option<Outcome> = None;
    for seed in 1..=count {
        let mut noise = Random::new(seed);
        let impacts = impacts(&mut noise);
        for base in bases {
            let outcome = Outcome::of(&format!("{name}-{seed}"), *base, &impacts);
            assert!(
                wanted(*base, &outcome),
                "{base:?}, {impacts:?}: {outcome:?}"
            );
            worst = Some(worst.map_or(outcome, |worst| worst.worse_of(&outcome)));
        }
    }
    println!("{name}: worst of {count} for {bases:?}: {worst:?}");
}

/// Whether no sample was rejected and no fall was reported.
fn is_consistent(outcome: &Outcome) -> bool {
    outcome.rejected == 0 && !outcome.falls
}

/// The gyro measures all of it. The attitude follows, and the estimate stays valid.
fn pushes_within_the_range(count: u64) {
    for bases in [&STANDING[..], &DRIVING[..]] {
        hold(
            "within-the-range",
            bases,
            count,
            |noise| vec![any_impact(noise, 6.0, 300.0, 1_950.0)],
            |_, outcome| {
                is_consistent(outcome)
                    && outcome.valid_after_s < -0.2
                    && outcome.valid_error_deg < 3.0
                    && outcome.late_deg < 2.0
            },
        );
    }
}

/// After 1.5 s of rest, or 4 s of driving, from the time the robot is upright, the tilt is known to 2° and the estimate
/// valid. Until then it is valid only if it is right.
fn recovers(base: Base, outcome: &Outcome) -> bool {
    let most_s = if base == Base::Driving { 4.0 } else { 1.5 };
    is_consistent(outcome)
        && outcome.late_deg < 2.0
        && outcome.valid_after_s < most_s
        && outcome.valid_error_deg < 4.0
}

fn impacts_beyond_the_range(count: u64) {
    for bases in [&STANDING[..], &DRIVING[..]] {
        hold(
            "beyond-the-range",
            bases,
            count,
            |noise| vec![any_impact(noise, 6.0, 2_000.0, 3_500.0)],
            recovers,
        );
    }
}

fn impacts_in_a_row(count: u64) {
    for bases in [&STANDING[..], &DRIVING[..]] {
        hold(
            "in-a-row",
            bases,
            count,
            |noise| {
                let first = any_impact(noise, 6.0, 500.0, 3_500.0);
                let next_s = first.end_s() + noise.between(0.02, 1.5);
                let next = any_impact(noise, next_s, 500.0, 3_500.0);
                vec![first, next]
            },
            recovers,
        );
    }
}

/// Ten impacts within four seconds, the robot being righted after each.
fn ten_impacts(count: u64) {
    hold(
        "ten",
        &STANDING,
        count,
        |noise| {
            (0..10)
                .map(|number| {
                    let mut impact =
                        any_impact(noise, 6.0 + 0.4 * f64::from(number), 1_000.0, 3_500.0);
                    impact.ms = 10.0;
                    impact
                })
                .collect()
        },
        recovers,
    );
}

#[test]
fn impacts_within_the_gyros_range_are_followed() {
    pushes_within_the_range(FEW);
}

#[test]
fn after_an_impact_beyond_the_range_the_tilt_is_found_again() {
    impacts_beyond_the_range(FEW);
}

#[test]
fn after_impacts_in_a_row_the_tilt_is_found_again() {
    impacts_in_a_row(FEW);
}

#[test]
fn ten_impacts_in_four_seconds_report_no_fall() {
    ten_impacts(FEW / 2);
}

#[test]
#[ignore = "takes minutes"]
fn hundreds_of_impacts() {
    pushes_within_the_range(MANY);
    impacts_beyond_the_range(MANY);
    impacts_in_a_row(MANY);
    ten_impacts(MANY);
}
