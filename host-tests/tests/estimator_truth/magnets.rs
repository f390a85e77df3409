//! Magnetic disturbances, and no magnetometer at all.

use robot_test_support::Vector;

use crate::{
    figures::Figures,
    motion::{Motion, window},
    run::Run,
    sensors::Sensors,
};

/// Across north, where they deflect it most, and along it.
const MAGNETS_UT: [(&str, Vector); 4] = [
    ("20 µT east", [20.0, 0.0, 0.0]),
    ("30 µT west and up", [-25.0, 0.0, 17.0]),
    ("60 µT south", [0.0, -60.0, 0.0]),
    ("40 µT down", [5.0, 0.0, -40.0]),
];

/// Yaws and rocks, as on an uneven floor.
fn driven() -> Motion {
    Motion::at_rest().turning(|t| {
        [
            10.0 * (2.1 * t).sin(),
            15.0 * (1.7 * t).cos(),
            60.0 * (0.4 * t).sin(),
        ]
    })
}

/// Norm or dip show the disturbance at once. Meanwhile the gyro holds the heading: its bias, known to 0.05 °/s, makes
/// 1.5° in half a minute.
#[test]
fn a_passing_magnet_does_not_rotate_the_estimate() {
    let mut figures = Figures::default();
    for (name, magnet_ut) in MAGNETS_UT {
        for (seconds, ramp_s) in [(5.0, 0.05), (30.0, 0.05), (15.0, 1.5)] {
            let motion = driven().with_magnet(move |t| {
                magnet_ut.map(|part| part * window(t, 60.0, 60.0 + seconds, ramp_s))
            });
            let mut run = Run::new(motion, Sensors::real());
            run.skip(60.0);
            let during = run.worst(60.0 + seconds + 5.0);
            run.skip(60.0 + seconds + 30.0);
            let after = run.worst(60.0 + seconds + 40.0);
            let name = format!("{name} for {seconds} s, ramps of {ramp_s} s");
            figures.at_most(&format!("{name}, heading in °"), during.heading_deg, 3.0);
            figures.at_most(
                &format!("{name}, inclination in °"),
                during.inclination_deg,
                0.5,
            );
            figures.at_most(
                &format!("{name}, heading half a minute later in °"),
                after.heading_deg,
                1.5,
            );
        }
    }
    figures.done();
}

/// Five times in a row, for 8 s each with 8 s between. The errors must not add up.
#[test]
fn a_magnet_passed_repeatedly_does_not_rotate_the_estimate() {
    let mut figures = Figures::default();
    let motion = driven().with_magnet(|t| {
        let near = (30.0..110.0).contains(&t) && t.rem_euclid(16.0) < 8.0;
        [if near { 35.0 } else { 0.0 }, 0.0, 0.0]
    });
    let mut run = Run::new(motion, Sensors::real());
    run.skip(30.0);
    let worst = run.worst(130.0);
    figures.at_most(
        "a magnet passed five times, heading in °",
        worst.heading_deg,
        3.0,
    );
    figures.done();
}

/// In another building the field stays different by 20°. The heading must follow it.
#[test]
fn the_field_of_a_new_place_is_adopted_within_three_minutes() {
    let mut figures = Figures::default();
    let east_ut = 19.146 * 20.0_f64.to_radians().tan();
    let motion = driven().with_magnet(move |t| {
        if t < 60.0 {
            [0.0; 3]
        } else {
            [east_ut, 0.0, -25.0]
        }
    });
    let mut run = Run::new(motion, Sensors::real());
    run.skip(60.0);
    let first = run.worst(75.0);
    figures.at_most(
        "new place, heading in the first 15 s in °",
        first.heading_deg,
        3.0,
    );
    run.skip(240.0);
    let to_new_north_deg = (run.error().heading_deg - 20.0).abs();
    figures.at_most(
        "new place, heading after three minutes against the field there in °",
        to_new_north_deg,
        3.0,
    );
    figures.done();
}

/// A magnet at power-on must not deflect the heading for good.
#[test]
fn a_magnet_at_the_start_is_no_lasting_error() {
    let mut figures = Figures::default();
    let motion = driven().with_magnet(|t| if t < 3.0 { [30.0, 0.0, 10.0] } else { [0.0; 3] });
    let mut run = Run::new(motion, Sensors::real());
    run.skip(60.0);
    let worst = run.worst(90.0);
    figures.at_most(
        "a magnet in the first 3 s, heading after a minute in °",
        worst.heading_deg,
        2.0,
    );
    figures.done();
}

/// An unknown bias of 0.05 °/s makes 3° in a minute. Nothing else suffers, and nothing jumps when the magnetometer
/// comes back.
#[test]
fn a_magnetometer_may_stop_and_return() {
    let mut figures = Figures::default();
    let sensors = Sensors::real().with_mag_while(|t| !(60.0..120.0).contains(&t));
    let mut run = Run::new(driven(), sensors);
    run.skip(60.0);
    let without = run.worst(120.0);
    let back = run.worst(150.0);
    run.skip(160.0);
    let after = run.worst(180.0);
    figures.at_most(
        "no magnetometer for a minute, heading in °",
        without.heading_deg,
        4.0,
    );
    figures.at_most(
        "no magnetometer for a minute, inclination in °",
        without.inclination_deg,
        0.5,
    );
    figures.at_most("magnetometer back, jump in °", back.jump_deg, 0.3);
    figures.at_most(
        "magnetometer back, heading 40 s later in °",
        after.heading_deg,
        1.0,
    );
    figures.done();
}

/// The first sample comes after a minute, and aligns the heading at once.
#[test]
fn a_magnetometer_may_start_late() {
    let mut figures = Figures::default();
    let motion = driven().starting(robot_test_support::Rotation::by_deg([0.0, 0.0, 120.0]));
    let mut run = Run::new(motion, Sensors::real().with_mag_while(|t| t > 60.0));
    run.skip(65.0);
    let worst = run.worst(80.0);
    figures.at_most(
        "magnetometer from a minute on, heading 5 s later in °",
        worst.heading_deg,
        2.0,
    );
    figures.done();
}

/// From the equator to the polar circles, north and south. Norm and dip are those of the World Magnetic Model.
#[test]
fn north_is_found_all_over_the_earth() {
    let mut figures = Figures::default();
    for (place, strength_ut, dip_deg) in [
        ("São Paulo", 22.5, -38.0),
        ("Singapore", 42.0, -15.0),
        ("Nairobi", 33.5, -25.0),
        ("Hobart", 61.5, -72.0),
        ("Reykjavik", 52.5, 75.5),
    ] {
        let motion = Motion::carried_about().where_field_is(strength_ut, dip_deg);
        let mut run = Run::new(motion, Sensors::real());
        run.skip(20.0);
        let worst = run.worst(120.0);
        figures.at_most(&format!("{place}, heading in °"), worst.heading_deg, 3.0);
        figures.at_most(
            &format!("{place}, inclination in °"),
            worst.inclination_deg,
            2.0,
        );
    }
    figures.done();
}

/// The tilt does not depend on the magnetometer.
#[test]
fn without_magnetometer_only_the_heading_suffers() {
    let mut figures = Figures::default();
    let mut without = Run::new(Motion::carried_about(), Sensors::real().without_mag());
    without.skip(5.0);
    let without = without.worst(180.0);
    figures.at_most(
        "carried without magnetometer, inclination in °",
        without.inclination_deg,
        2.0,
    );
    figures.at_most(
        "carried without magnetometer, drift in three minutes in °",
        without.heading_drift_deg,
        20.0,
    );
    figures.done();
}
