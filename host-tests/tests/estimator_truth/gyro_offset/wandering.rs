//! The offset as temperature moves it.

use std::f64::consts::TAU;

use crate::{figures::Figures, motion::Motion, run::Run, sensors::Sensors};

const MINUTES: f64 = 10.0;

fn wandering(seed: u64) -> Sensors {
    let mut sensors = Sensors::real().without_mag();
    sensors.seed = seed;
    sensors.gyro_offset_dps = Box::new(|t| {
        let wave = |period_s: f64| 0.1 * (TAU * t / period_s).sin();
        [wave(300.0), wave(500.0), wave(400.0) + 0.1 * t / 600.0]
    });
    sensors
}

/// The offset about the vertical changes by at most 0.0017 °/s each second. Found with a lag of 10 s that is 0.017 °/s,
/// up and down again; the ramp's share of it adds up to 1° in ten minutes.
#[test]
fn at_rest_a_wandering_offset_turns_nothing() {
    let mut figures = Figures::default();
    for seed in 1..4 {
        let mut run = Run::new(Motion::at_rest(), wandering(seed));
        run.skip(5.0);
        let worst = run.worst(60.0 * MINUTES);
        figures.at_most(
            "ten minutes of rest, drift in °",
            worst.heading_drift_deg,
            2.0,
        );
        figures.at_most(
            "ten minutes of rest, inclination in °",
            worst.inclination_deg,
            0.3,
        );
    }
    figures.done();
}
