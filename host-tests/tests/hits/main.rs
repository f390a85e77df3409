//! Blows and pushes, within the gyro's range and beyond it, through the models of the board's sensors, the app's own
//! sensing and its estimator: how soon up is known again, and whether the estimate says so.
//!
//! The motion is made up in double precision (`motion`); the robot is hit while it stands, turns or drives. Each test
//! takes a few blows by chance; `--ignored` takes hundreds.

#[path = "../recorded_through_sensors/board.rs"]
mod board;
mod motion;
mod record;
mod run;
#[path = "../closed_loop/sensors.rs"]
mod sensors;

use motion::{Base, Blow};
use robot_test_support::{Random, Vector};
use run::Outcome;

const FEW: u64 = 8;
const MANY: u64 = 150;
const STANDING: [Base; 2] = [Base::Standing, Base::Turning { dps: 60 }];
const DRIVING: [Base; 1] = [Base::Driving];
/// What nobody survives upright is left out, °.
const MOST_DEG: f64 = 90.0;

/// Between these peaks in °/s, of 10 to 100 ms, about any axis.
fn any_blow(noise: &mut Random, at_s: f64, from_dps: f64, to_dps: f64) -> Blow {
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
        return Blow {
            at_s: at_s + noise.between(0.0, 0.2),
            axis: direction(noise),
            peak_dps,
            ms,
            abrupt,
            accel_mps2: robot_test_support::scale(direction(noise), push_mps2(noise, ms)),
        };
    }
}

/// Up to what the accelerometer cannot see, or what makes a robot 2 m/s faster.
fn push_mps2(noise: &mut Random, ms: f64) -> f64 {
    if noise.unit() < 0.5 {
        return noise.between(80.0, 400.0);
    }
    noise.between(0.0, 2.0) / (ms * 1e-3)
}

/// Half of them along an axis of the body, as robots are hit.
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

/// What is wanted of each, and the worst of all.
fn hold(
    name: &str,
    bases: &[Base],
    count: u64,
    blows: impl Fn(&mut Random) -> Vec<Blow>,
    wanted: impl Fn(Base, &Outcome) -> bool,
) {
    let mut worst: Option<Outcome> = None;
    for seed in 1..=count {
        let mut noise = Random::new(seed);
        let blows = blows(&mut noise);
        for base in bases {
            let outcome = Outcome::of(&format!("{name}-{seed}"), *base, &blows);
            assert!(wanted(*base, &outcome), "{base:?}, {blows:?}: {outcome:?}");
            worst = Some(worst.map_or(outcome, |worst| worst.worse_of(&outcome)));
        }
    }
    println!("{name}: worst of {count} for {bases:?}: {worst:?}");
}

/// In any case: no sample is thrown away, no fall is made up.
fn sound(outcome: &Outcome) -> bool {
    outcome.rejected == 0 && !outcome.falls
}

/// The gyro sees all of it: the attitude follows, and counts all the time.
fn pushes_within_the_range(count: u64) {
    for bases in [&STANDING[..], &DRIVING[..]] {
        hold(
            "within-the-range",
            bases,
            count,
            |noise| vec![any_blow(noise, 6.0, 300.0, 1_950.0)],
            |_, outcome| {
                sound(outcome)
                    && outcome.valid_after_s < -0.2
                    && outcome.lie_deg < 3.0
                    && outcome.late_deg < 2.0
            },
        );
    }
}

/// 1.5 s of rest, or 4 s of driving, after the robot was righted: up is known to 2°, and the estimate counts. Until then
/// it counts only if it is right.
fn recovers(base: Base, outcome: &Outcome) -> bool {
    let most_s = if base == Base::Driving { 4.0 } else { 1.5 };
    sound(outcome)
        && outcome.late_deg < 2.0
        && outcome.valid_after_s < most_s
        && outcome.lie_deg < 4.0
}

fn blows_beyond_the_range(count: u64) {
    for bases in [&STANDING[..], &DRIVING[..]] {
        hold(
            "beyond-the-range",
            bases,
            count,
            |noise| vec![any_blow(noise, 6.0, 2_000.0, 3_500.0)],
            recovers,
        );
    }
}

fn blows_in_a_row(count: u64) {
    for bases in [&STANDING[..], &DRIVING[..]] {
        hold(
            "in-a-row",
            bases,
            count,
            |noise| {
                let first = any_blow(noise, 6.0, 500.0, 3_500.0);
                let next_s = first.end_s() + noise.between(0.02, 1.5);
                let next = any_blow(noise, next_s, 500.0, 3_500.0);
                vec![first, next]
            },
            recovers,
        );
    }
}

/// Ten within four seconds, each righted before the next.
fn ten_blows(count: u64) {
    hold(
        "ten",
        &STANDING,
        count,
        |noise| {
            (0..10)
                .map(|number| {
                    let mut blow = any_blow(noise, 6.0 + 0.4 * f64::from(number), 1_000.0, 3_500.0);
                    blow.ms = 10.0;
                    blow
                })
                .collect()
        },
        recovers,
    );
}

#[test]
fn pushes_within_the_gyros_range_are_followed() {
    pushes_within_the_range(FEW);
}

#[test]
fn after_a_blow_beyond_the_range_up_is_found_again() {
    blows_beyond_the_range(FEW);
}

#[test]
fn after_blows_in_a_row_up_is_found_again() {
    blows_in_a_row(FEW);
}

#[test]
fn ten_blows_in_four_seconds_make_up_no_fall() {
    ten_blows(FEW / 2);
}

#[test]
#[ignore = "takes minutes"]
fn hundreds_of_blows() {
    pushes_within_the_range(MANY);
    blows_beyond_the_range(MANY);
    blows_in_a_row(MANY);
    ten_blows(MANY);
}
