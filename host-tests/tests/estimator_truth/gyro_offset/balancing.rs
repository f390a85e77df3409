//! A balancing robot is never at rest: it sways.

use std::f64::consts::TAU;

use crate::{figures::Figures, motion::Motion, run::Run, sensors::Sensors};

const SWAY_DEG: f64 = 1.5;
const SWAY_HZ: f64 = 0.9;

/// Pitches back and forth, with the axle below it moving along.
fn swaying() -> Motion {
    let phase = |t: f64| TAU * SWAY_HZ * t;
    Motion::at_rest()
        .turning(move |t| [0.0, SWAY_DEG * TAU * SWAY_HZ * phase(t).cos(), 0.0])
        .accelerated(move |t| [0.4 * phase(t).sin(), 0.0, 0.0])
}

/// The field shows the bias about the vertical. 0.1 °/s makes 2° in 20 s; a sample's noise of 0.3 µT in 19 µT is 0.9°.
#[test]
fn a_balancing_robot_finds_its_gyro_bias() {
    let mut figures = Figures::default();
    for offset_dps in [[0.3, -0.2, 0.5], [2.0, -2.0, 3.0], [0.0, 0.0, -6.0]] {
        let sensors = Sensors::real().with_offset(offset_dps);
        let mut run = Run::new(swaying(), sensors);
        run.skip(60.0);
        let worst = run.worst(180.0);
        let name = format!("balancing with {offset_dps:?} °/s, from a minute on");
        figures.at_most(&format!("{name}, offset in °/s"), run.bias_error_dps(), 0.1);
        figures.at_most(&format!("{name}, heading in °"), worst.heading_deg, 2.0);
        figures.at_most(
            &format!("{name}, inclination in °"),
            worst.inclination_deg,
            0.5,
        );
    }
    figures.done();
}
