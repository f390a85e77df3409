//! An offset of many °/s from the first sample on, as if no calibration had taken it out.

use robot_test_support::{Vector, norm, scale};

use crate::{
    figures::Figures,
    motion::{Motion, carried_rate_dps, window},
    run::Run,
    sensors::Sensors,
};

/// Up to here the horizon tilts by less than half a radian in three seconds: small enough to be put right at one go.
const LARGE_DPS: f64 = 9.0;

const OFFSETS_DPS: [(&str, Vector); 6] = [
    ("1 °/s", [0.6, -0.6, 0.5]),
    ("4.4 °/s", [2.5, -2.5, 2.6]),
    ("5 °/s about x", [5.0, 0.0, 0.0]),
    ("-5 °/s about z", [0.0, 0.0, -5.0]),
    ("8.7 °/s", [5.0, -5.0, 5.0]),
    ("17 °/s", [-10.0, 10.0, 10.0]),
];

/// At rest the offset is what the gyro shows; two seconds tell rest from motion, and then the mean of half a second of
/// samples (0.14 °/s each) is right to 0.02 °/s.
#[test]
fn at_rest_the_offset_is_found_within_five_seconds() {
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

/// Without a magnetometer the heading keeps the value it had when the offset was found.
#[test]
fn at_rest_without_magnetometer_the_heading_stands_once_the_offset_is_found() {
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

/// Three seconds of rest, then carried about without end.
fn soon_carried() -> Motion {
    let carried = Motion::carried_about();
    let (turning, pushing) = (carried.rate_rps, carried.accel_mps2);
    let mut motion = Motion::at_rest();
    motion.rate_rps = Box::new(move |t| scale(turning(t), window(t, 3.0, 1e9, 0.5)));
    motion.accel_mps2 = Box::new(move |t| scale(pushing(t), window(t, 3.0, 1e9, 0.5)));
    motion
}

/// Gravity and field show two turns, so all three axes of the offset, at any time: the tilt that 0.3 °/s makes in three
/// seconds (1°) stands out of the pushes' mean. Half a minute is ten such looks, a minute twenty.
#[test]
fn in_motion_the_offset_is_found_within_half_a_minute_or_a_minute() {
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

/// Gravity alone shows the offset's part across the vertical; the body turns, so each axis gets its chance.
#[test]
fn in_motion_without_magnetometer_the_offset_is_found_within_a_minute() {
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

/// Set down while it still turns: what lasts for little more than a second is no rest yet.
#[test]
fn a_short_slow_turn_at_the_start_is_a_turn() {
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

/// No offset, and none made up: what is carried about for three minutes keeps an offset near zero, once the first ten
/// seconds have shown that there is none.
#[test]
fn motion_makes_up_no_offset() {
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
