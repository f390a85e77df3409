//! Poses that are singular for angles: vertical, upside down, half turns; and power-on in any of them.

use robot_test_support::{Rotation, Vector};
use std::f64::consts::TAU;

use crate::{
    figures::Figures,
    motion::{Motion, window},
    run::Run,
    sensors::Sensors,
};

/// Poses at power-on: nine tilts by six headings. One of them is west, where the angle wraps.
fn poses() -> impl Iterator<Item = Rotation> {
    const TILTS_DEG: [Vector; 9] = [
        [0.0, 0.0, 0.0],
        [45.0, 0.0, 0.0],
        [-90.0, 0.0, 0.0],
        [180.0, 0.0, 0.0],
        [0.0, 90.0, 0.0],
        [0.0, -90.0, 0.0],
        [0.0, 180.0, 0.0],
        [0.0, -135.0, 0.0],
        [127.0, 127.0, 0.0],
    ];
    TILTS_DEG.into_iter().flat_map(|tilt_deg| {
        (0..6).map(move |sixth| {
            let heading = Rotation::by_deg([0.0, 0.0, 60.0 * f64::from(sixth) - 180.0]);
            heading.then_in_body(Rotation::by_deg(tilt_deg))
        })
    })
}

/// Checked from the first valid estimate on. A hundred samples average the noise to 0.01° of tilt, 25 field samples of
/// 0.3 µT against 19 µT to 0.2° of heading.
#[test]
fn every_pose_is_known_once_it_is_valid() {
    let mut figures = Figures::default();
    let (mut heading_deg, mut inclination_deg) = (0.0_f64, 0.0_f64);
    for (number, pose) in poses().enumerate() {
        let sensors = Sensors {
            seed: number as u64,
            ..Sensors::real()
        };
        let mut run = Run::new(Motion::at_rest().starting(pose), sensors);
        run.skip(0.5);
        assert!(run.estimate.valid);
        let worst = run.worst(20.0);
        heading_deg = heading_deg.max(worst.heading_deg);
        inclination_deg = inclination_deg.max(worst.inclination_deg);
    }
    figures.at_most("waking up in any pose, heading in °", heading_deg, 3.0);
    figures.at_most(
        "waking up in any pose, inclination in °",
        inclination_deg,
        0.5,
    );
    figures.done();
}

/// Back and forth by ±130° about y: nose down, nose up and beyond, where roll and yaw jump by half a turn.
#[test]
fn the_vertical_is_no_singularity() {
    let rate_dps = |t: f64| {
        [
            0.0,
            130.0 * TAU * 0.2 * (TAU * 0.2 * t).cos() * window(t, 0.5, 1e9, 1.0),
            0.0,
        ]
    };
    let mut figures = Figures::default();
    for heading_deg in [0.0, 135.0] {
        let motion = Motion::at_rest()
            .starting(Rotation::by_deg([0.0, 0.0, heading_deg]))
            .turning(rate_dps);
        let mut run = Run::new(motion, Sensors::ideal());
        run.skip(0.5);
        let worst = run.worst(60.0);
        figures.at_most("through the vertical, total in °", worst.total_deg, 0.3);
        figures.at_most("through the vertical, jump in °", worst.jump_deg, 0.05);
    }
    figures.done();
}

/// Half turns within half a second about each axis, with three seconds of rest between.
#[test]
fn half_turns_are_followed() {
    let mut figures = Figures::default();
    for axis in 0..3 {
        for sign in [1.0, -1.0] {
            let rate_dps = move |t: f64| {
                let mut rate = [0.0; 3];
                // Area of the trapezium: 180°.
                rate[axis] = sign * 450.0 * window(t.rem_euclid(3.5), 3.0, 3.5, 0.1);
                rate
            };
            for sensors in [Sensors::real(), Sensors::real().without_mag()] {
                let mut run = Run::new(Motion::at_rest().turning(rate_dps), sensors);
                run.skip(2.0);
                let worst = run.worst(40.0);
                let name = format!("half turns about axis {axis}");
                figures.at_most(&format!("{name}, drift in °"), worst.heading_drift_deg, 1.5);
                figures.at_most(
                    &format!("{name}, inclination in °"),
                    worst.inclination_deg,
                    0.7,
                );
            }
        }
    }
    figures.done();
}
