//! Continuous rotation past ±π, up to the end of the gyro's range.

use robot_test_support::{Rotation, Vector, scale};

use crate::{
    figures::Figures,
    motion::{Motion, window},
    run::Run,
    sensors::Sensors,
};

const AXES: [(&str, Vector); 4] = [
    ("x", [1.0, 0.0, 0.0]),
    ("y", [0.0, -1.0, 0.0]),
    ("z", [0.0, 0.0, 1.0]),
    ("xyz", [0.577_350_269, 0.577_350_269, -0.577_350_269]),
];

/// Two seconds of rest, then up to speed within a second.
fn spin(axis: Vector, speed_dps: f64) -> Motion {
    Motion::at_rest()
        .starting(Rotation::by_deg([10.0, -20.0, 70.0]))
        .turning(move |t| scale(axis, speed_dps * window(t, 2.0, 1e9, 1.0)))
}

/// The mean force of 5 ms belongs to the middle of its interval, the field to the middle of its measurement. At 1,900
/// °/s that is 4.8° and 7.6° from the attitude of the tick. A filter that accounts for it stays within half a degree.
/// Two minutes of rotation are up to 228,000°, of which single precision may lose 2e-6.
#[test]
fn spinning_stays_on_the_truth() {
    let mut figures = Figures::default();
    for (name, axis) in AXES {
        for speed_dps in [200.0, 720.0, 1_900.0] {
            let mut run = Run::new(spin(axis, speed_dps), Sensors::ideal());
            run.skip(2.0);
            let worst = run.worst(120.0);
            let name = format!("spin about {name} at {speed_dps} °/s");
            figures.at_most(&format!("{name}, heading in °"), worst.heading_deg, 0.5);
            figures.at_most(
                &format!("{name}, inclination in °"),
                worst.inclination_deg,
                0.5,
            );
            figures.at_most(&format!("{name}, jump in °"), worst.jump_deg, 0.1);
        }
    }
    figures.done();
}

#[test]
fn spinning_without_magnetometer_keeps_the_heading() {
    let mut figures = Figures::default();
    for (name, axis) in AXES {
        for speed_dps in [-200.0, 1_900.0] {
            let mut run = Run::new(spin(axis, speed_dps), Sensors::ideal().without_mag());
            run.skip(2.0);
            let worst = run.worst(120.0);
            let name = format!("6d spin about {name} at {speed_dps} °/s");
            figures.at_most(
                &format!("{name}, heading drift in °"),
                worst.heading_drift_deg,
                0.5,
            );
            figures.at_most(
                &format!("{name}, inclination in °"),
                worst.inclination_deg,
                0.5,
            );
        }
    }
    figures.done();
}

/// Between samples the attitude is extrapolated with the last rate. At a steady rate no tick is off.
#[test]
fn an_even_rotation_shows_no_steps() {
    let mut figures = Figures::default();
    for (name, axis) in AXES {
        let mut run = Run::new(spin(axis, 1_000.0), Sensors::ideal());
        run.skip(10.0);
        let worst = run.worst(12.0);
        // The robot rotates by 1° a tick. An output without extrapolation would jump by 1° and then by 4° back.
        figures.at_most(
            &format!("steady turn about {name}, jump in °"),
            worst.jump_deg,
            0.05,
        );
    }
    figures.done();
}
