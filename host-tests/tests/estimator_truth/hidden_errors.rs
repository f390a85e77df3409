//! Errors of the sensors that nobody measured beforehand: motion shows them.

use robot_test_support::Vector;

use crate::{
    figures::Figures,
    motion::{Motion, carried_rate_dps, window},
    run::Run,
    sensors::Sensors,
};

/// Two minutes of learning, then a minute that counts.
fn learnt(figures: &mut Figures, name: &str, motion: Motion, sensors: Sensors, heading_deg: f64) {
    let mut run = Run::new(motion, sensors);
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
        learnt(&mut figures, name, Motion::carried_about(), sensors, 3.0);
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
        learnt(&mut figures, &name, Motion::carried_about(), sensors, 6.0);
    }
    figures.done();
}

/// Turning to and fro shows it; while spinning one way 25 ms at 150 °/s would be 3.8° of heading.
#[test]
fn a_field_that_is_older_than_its_stamp() {
    let mut figures = Figures::default();
    let motion = Motion::carried_about().turning(|t| {
        let spin = window(t, 118.0, 1e9, 1.0);
        let [x, y, z] = carried_rate_dps(t).map(|rate| rate * (1.0 - spin));
        [x, y, z + 150.0 * spin]
    });
    let mut sensors = Sensors::real();
    sensors.unknown_mag_delay_us = 25_000;
    learnt(&mut figures, "field 25 ms older", motion, sensors, 1.0);
    figures.done();
}
