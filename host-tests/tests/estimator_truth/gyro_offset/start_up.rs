//! A large bias from the first sample on, as without a start-up calibration.

use robot_test_support::{Vector, norm, scale};

use crate::{
    figures::Figures,
    motion::{Motion, carried_rate_dps, window},
    run::Run,
    sensors::Sensors,
};

/// Up to this bias the estimate tilts by less than half a radian in three seconds, which one correction can repair.
const LARGE_DPS: f64 = 9.0;

const OFFSETS_DPS: [(&str, Vector); 6] = [
    ("1 °/s", [0.6, -0.6, 0.5]),
    ("4.4 °/s", [2.5, -2.5, 2.6]),
    ("5 °/s about x", [5.0, 0.0, 0.0]),
    ("-5 °/s about z", [0.0, 0.0, -5.0]),
    ("8.7 °/s", [5.0, -5.0, 5.0]),
    ("17 °/s", [-10.0, 10.0, 10.0]),
];

/// At rest the gyro shows its bias. Two seconds tell rest from motion. The mean over another half second of samples
/// with a noise of 0.14 °/s is right to 0.02 °/s.
#[test]
fn at_rest_the_bias_is_found_within_five_seconds() {
    let mut figures = Figures::default();
    for (name, offset_dps) in OFFSETS_DPS {
        let mut run = Run::new(Motion::at_rest(), Sensors::real().with_offset(offset_dps));
        run.skip(5.0);
        figures.at_most(
            &format!("{name} at rest after 5 s, offset in °/s"),
            run.bias_error_dps(),
            0.1,
        );
        run.skip(10.0);
        let worst = run.worst(60.0);
        figures.at_most(
            &format!("{name} at rest from 10 s on, heading in °"),
            worst.heading_deg,
            2.0,
        );
        figures.at_most(
            &format!("{name} at rest from 10 s on, inclination in °"),
            worst.inclination_deg,
            0.5,
        );
    }
    figures.done();
}

/// Without a magnetometer the heading stays where it was when the bias was found.
#[test]
fn at_rest_without_magnetometer_the_heading_stays_once_the_bias_is_found() {
    let mut figures = Figures::default();
    for (name, offset_dps) in OFFSETS_DPS {
        let sensors = Sensors::real().with_offset(offset_dps).without_mag();
        let mut run = Run::new(Motion::at_rest(), sensors);
        run.skip(5.0);
        figures.at_most(
            &format!("6d {name} after 5 s, offset in °/s"),
            run.bias_error_dps(),
            0.1,
        );
        run.skip(10.0);
        let worst = run.worst(60.0);
        figures.at_most(
            &format!("6d {name} from 10 s on, drift in °"),
            worst.heading_drift_deg,
            1.0,
        );
        figures.at_most(
            &format!("6d {name} from 10 s on, inclination in °"),
            worst.inclination_deg,
            0.5,
        );
    }
    figures.done();
}

/// Three seconds of rest, then motion without end.
fn soon_carried() -> Motion {
    let carried = Motion::carried_about();
    let (turning, pushing) = (carried.rate_rps, carried.accel_mps2);
    let mut motion = Motion::at_rest();
    motion.rate_rps = Box::new(move |t| scale(turning(t), window(t, 3.0, 1e9, 0.5)));
    motion.accel_mps2 = Box::new(move |t| scale(pushing(t), window(t, 3.0, 1e9, 0.5)));
    motion
}

/// Gravity and field make all three axes of the bias observable. In three seconds 0.3 °/s tilt by 1°, which exceeds the
/// mean of the accelerations. Half a minute has ten such intervals, a minute twenty.
#[test]
fn in_motion_the_bias_is_found_within_half_a_minute_or_a_minute() {
    let mut figures = Figures::default();
    for (name, offset_dps) in OFFSETS_DPS {
        for (start, motion) in [
            ("after 3 s of rest", soon_carried as fn() -> Motion),
            ("from the start", Motion::carried_about),
        ] {
            let mut run = Run::new(motion(), Sensors::real().with_offset(offset_dps));
            let found_s = if norm(offset_dps) < LARGE_DPS {
                30.0
            } else {
                60.0
            };
            run.skip(found_s);
            let name = format!("{name}, carried {start}");
            figures.at_most(
                &format!("{name}, offset after {found_s} s in °/s"),
                run.bias_error_dps(),
                0.3,
            );
            let worst = run.worst(found_s + 60.0);
            figures.at_most(
                &format!("{name}, heading from then on in °"),
                worst.heading_deg,
                4.0,
            );
            figures.at_most(
                &format!("{name}, inclination from then on in °"),
                worst.inclination_deg,
                2.0,
            );
        }
    }
    figures.done();
}

/// Gravity alone shows the bias across the vertical. The body rotates, so that each axis is across it at times.
#[test]
fn in_motion_without_magnetometer_the_bias_is_found_within_a_minute() {
    let mut figures = Figures::default();
    for (name, offset_dps) in OFFSETS_DPS {
        let sensors = Sensors::real().with_offset(offset_dps).without_mag();
        let mut run = Run::new(soon_carried(), sensors);
        run.skip(60.0);
        figures.at_most(
            &format!("6d {name}, carried, offset after 60 s in °/s"),
            run.bias_error_dps(),
            0.3,
        );
        let worst = run.worst(120.0);
        figures.at_most(
            &format!("6d {name}, carried, drift within a minute in °"),
            worst.heading_drift_deg,
            10.0,
        );
        figures.at_most(
            &format!("6d {name}, carried, inclination in °"),
            worst.inclination_deg,
            2.0,
        );
    }
    figures.done();
}

/// A robot is set down while it still rotates. A little more than a second of that is no rest yet.
#[test]
fn a_short_slow_rotation_at_the_start_is_no_bias() {
    let mut figures = Figures::default();
    for speed_dps in [4.0, -8.0] {
        let motion =
            Motion::at_rest().turning(move |t| [0.0, 0.0, speed_dps * window(t, -1.0, 1.2, 0.1)]);
        let mut run = Run::new(motion, Sensors::real().without_mag());
        run.skip(0.01);
        let worst = run.worst(20.0);
        figures.at_most(
            &format!("6d turned at {speed_dps} °/s for 1.2 s, drift in °"),
            worst.heading_drift_deg,
            0.5,
        );
    }
    figures.done();
}

/// Without any bias, after ten seconds that show so, three minutes of motion must not make one up.
#[test]
fn motion_makes_up_no_bias() {
    let mut figures = Figures::default();
    for (name, sensors) in [
        ("9d", Sensors::real()),
        ("6d", Sensors::real().without_mag()),
    ] {
        assert!(carried_rate_dps(0.0).iter().any(|rate| rate.abs() > 10.0));
        let mut run = Run::new(Motion::carried_about(), sensors);
        let mut bias_dps = 0.0_f64;
        for second in 10..180 {
            run.skip(f64::from(second));
            bias_dps = bias_dps.max(run.bias_error_dps());
        }
        figures.at_most(
            &format!("{name} carried without offset, offset in °/s"),
            bias_dps,
            0.3,
        );
    }
    figures.done();
}
