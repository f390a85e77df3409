//! Sensor errors that no calibration has measured, and that motion makes observable.

use robot_test_support::Vector;

use crate::{
    figures::Figures,
    motion::{Motion, carried_rate_dps, window},
    run::Run,
    sensors::Sensors,
};

/// Two minutes to converge, then a minute that is measured.
fn converged(
    figures: &mut Figures,
    name: &str,
    motion: Motion,
    sensors: Sensors,
    heading_deg: f64,
) {
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

/// The BMI088 may have 1 % of scale error and 1 % of cross-axis sensitivity. A swing by 60° is then off by 0.6°.
#[test]
fn a_gyro_misalignment_of_one_per_cent_is_found() {
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
        converged(&mut figures, name, Motion::carried_about(), sensors, 3.0);
    }
    figures.done();
}

/// 12 µT against 19 µT of horizontal field deflect north by 32° either way. Over all attitudes the earth's field is the
/// part that is constant in the world, hard iron the part that is constant in the body.
#[test]
fn hard_iron_is_found() {
    let mut figures = Figures::default();
    for magnet_ut in [[12.0, 0.0, 0.0], [0.0, -8.0, 8.0], [5.0, 5.0, -9.0]] {
        let mut sensors = Sensors::real();
        sensors.hard_iron_ut = magnet_ut;
        let name = format!("carried magnet of {magnet_ut:?} µT");
        converged(&mut figures, &name, Motion::carried_about(), sensors, 6.0);
    }
    figures.done();
}

/// Rotation back and forth shows the delay. In a rotation one way 25 ms at 150 °/s would be 3.8° of heading.
#[test]
fn a_delay_of_the_magnetometer_is_found() {
    let mut figures = Figures::default();
    let motion = Motion::carried_about().turning(|t| {
        let spin = window(t, 118.0, 1e9, 1.0);
        let [x, y, z] = carried_rate_dps(t).map(|rate| rate * (1.0 - spin));
        [x, y, z + 150.0 * spin]
    });
    let mut sensors = Sensors::real();
    sensors.unknown_mag_delay_us = 25_000;
    converged(&mut figures, "field 25 ms older", motion, sensors, 1.0);
    figures.done();
}
