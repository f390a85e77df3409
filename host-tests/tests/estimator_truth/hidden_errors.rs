//! Errors of the sensors that nobody measured beforehand: motion shows them.

use crate::{figures::Figures, motion::Motion, rotation::Vector, run::Run, sensors::Sensors};

/// Two minutes of learning, then a minute that counts.
fn learnt(figures: &mut Figures, name: &str, sensors: Sensors, heading_deg: f64) {
    let mut run = Run::new(Motion::carried_about(), sensors);
    run.skip(120.0);
    let worst = run.worst(180.0);
    figures.at_most(
        &format!("{name}, heading in °"),
        worst.heading_deg,
        heading_deg,
    );
    figures.at_most(
        &format!("{name}, inclination in °"),
        worst.inclination_deg,
        1.5,
    );
}

/// The BMI088 may be 1 % off in scale and have 1 % of cross-talk between its axes. A swing by 60° is then 0.6° off.
#[test]
fn a_gyro_that_is_one_per_cent_off() {
    let mut figures = Figures::default();
    let scaled: [(&str, [Vector; 3]); 3] = [
        (
            "all axes 1 % too much",
            [[1.01, 0.0, 0.0], [0.0, 1.01, 0.0], [0.0, 0.0, 1.01]],
        ),
        (
            "one more, one less",
            [[0.99, 0.0, 0.0], [0.0, 1.01, 0.0], [0.0, 0.0, 0.99]],
        ),
        (
            "crooked axes",
            [[1.0, 0.01, -0.01], [0.01, 1.0, 0.01], [-0.01, 0.01, 1.0]],
        ),
    ];
    for (name, gyro_matrix) in scaled {
        let mut sensors = Sensors::real();
        sensors.gyro_matrix = gyro_matrix;
        learnt(&mut figures, name, sensors, 3.0);
    }
    figures.done();
}

/// 12 µT against 19 µT of level field turn north by 32° one way and the other. In all attitudes the earth's field is the
/// part that stays in the world, the magnet's the part that stays in the body.
#[test]
fn a_carried_magnet_is_found() {
    let mut figures = Figures::default();
    for magnet_ut in [[12.0, 0.0, 0.0], [0.0, -8.0, 8.0], [5.0, 5.0, -9.0]] {
        let mut sensors = Sensors::real();
        sensors.carried_magnet_ut = magnet_ut;
        let name = format!("carried magnet of {magnet_ut:?} µT");
        learnt(&mut figures, &name, sensors, 6.0);
    }
    figures.done();
}

/// 25 ms at 100 °/s are 2.5°.
#[test]
fn a_field_that_is_older_than_its_stamp() {
    let mut figures = Figures::default();
    let mut sensors = Sensors::real();
    sensors.unknown_mag_delay_us = 25_000;
    learnt(&mut figures, "field 25 ms older", sensors, 1.0);
    figures.done();
}
