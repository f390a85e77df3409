//! Which headings are believed, how far, and when what was believed is doubted.

mod moving;

use super::*;
use crate::{
    estimation::{
        strapdown::Strapdown,
        testing::{Rotation, to_f32},
    },
    math::Quaternion,
};

const WINDOW_S: f32 = 0.2;
const RAD: f64 = std::f64::consts::PI / 180.0;
const EARTH_UT: [f64; 3] = [0.0, 20.0, -45.0];
/// 0.5° of inclination, 1° of heading.
const SURE: AttitudeVariance = AttitudeVariance {
    tilt: (0.5 * DEG) * (0.5 * DEG),
    heading: DEG * DEG,
};

/// A robot that stands, and believes its heading as it is.
struct Robot {
    magnetic: MagneticHeading,
    strapdown: Strapdown,
    attitude: Rotation,
}

impl Robot {
    fn new() -> Self {
        let mut strapdown = Strapdown::new();
        strapdown.attitude = Quaternion::from_rotation([0.1, -0.2, 0.8]);
        Self {
            attitude: Rotation::of(strapdown.attitude),
            strapdown,
            magnetic: MagneticHeading::new(),
        }
    }

    /// North is known, and believed for so long.
    fn aligned(seconds: f32) -> Self {
        let mut robot = Self::new();
        let report = robot.window(0.0, SURE);
        assert!(report.initial_heading_rad.is_some());
        robot.believe(seconds);
        robot
    }

    fn believe(&mut self, seconds: f32) {
        for _ in 0..(seconds / WINDOW_S).round() as u32 {
            assert!(self.window(0.0, SURE).heading.is_some());
        }
    }

    /// Ten samples of a field whose north is turned to the left by `north_deg`.
    fn window(&mut self, north_deg: f64, known: AttitudeVariance) -> HeadingReport {
        let field = Rotation::by([0.0, 0.0, north_deg * RAD]).apply(EARTH_UT);
        self.window_of(field, known)
    }

    fn window_of(&mut self, field_enu_ut: [f64; 3], known: AttitudeVariance) -> HeadingReport {
        for _ in 0..10 {
            let seen = self.attitude.seen_from_body(field_enu_ut);
            self.magnetic.feed(to_f32(seen), &self.strapdown, 0.0);
        }
        self.magnetic.close_window(WINDOW_S, known)
    }

    /// Windows with north elsewhere until what was believed is doubted, s.
    fn doubted_after_s(&mut self, north_deg: f64) -> Option<f32> {
        (1_u16..1_000).find_map(|window| {
            let report = self.window(north_deg, SURE);
            assert!(report.heading.is_none());
            (report.added_variance_rad2 > 0.0).then(|| f32::from(window) * WINDOW_S)
        })
    }
}

fn heading_deg(report: HeadingReport) -> f32 {
    report.heading.expect("a heading").innovation.to_degrees()
}

#[test]
fn the_first_sample_and_the_first_window_show_north_at_once() {
    let mut robot = Robot::new();
    let seen = robot
        .attitude
        .seen_from_body(Rotation::by([0.0, 0.0, -100.0 * RAD]).apply(EARTH_UT));
    // North seems to lie 100° to the right: the robot must turn left to bring it back.
    let turn = robot.magnetic.feed(to_f32(seen), &robot.strapdown, 0.0);
    assert!((turn.expect("a turn").to_degrees() - 100.0).abs() < 0.01);
    let report = robot.window(-3.0, SURE);
    let first = report.initial_heading_rad.expect("a heading").to_degrees();
    assert!((first - 3.0).abs() < 0.01, "{first}");
    assert!(report.heading.is_none());
    // From then on it is corrected little by little.
    let report = robot.window(-3.0, SURE);
    assert!(report.initial_heading_rad.is_none());
    assert!((heading_deg(report) - 3.0).abs() < 0.01);
}

#[test]
fn north_is_found_anew_until_the_inclination_is_sure() {
    let mut robot = Robot::new();
    let unsure = AttitudeVariance {
        tilt: (4.0 * DEG) * (4.0 * DEG),
        ..SURE
    };
    robot.window(0.0, unsure);
    for _ in 0..5 {
        let report = robot.window(0.0, unsure);
        assert!(report.initial_heading_rad.is_some() && report.heading.is_none());
    }
    robot.window(0.0, SURE);
    assert!(robot.window(0.0, SURE).heading.is_some());
    // Later the field waits until the inclination is sure again.
    let report = robot.window(0.0, unsure);
    assert!(report.initial_heading_rad.is_none() && report.heading.is_none());
    assert!(robot.window(0.0, SURE).heading.is_some());
}

#[test]
fn a_turn_of_north_to_the_left_is_a_turn_of_the_robot_to_the_right() {
    let mut robot = Robot::aligned(10.0);
    assert!((heading_deg(robot.window(5.0, SURE)) + 5.0).abs() < 0.01);
    assert!((heading_deg(robot.window(-5.0, SURE)) - 5.0).abs() < 0.01);
}

/// Buildings turn the field by 5°; with 1° of its own the heading's spread is 5.1°: clipped at two, refused at three.
#[test]
fn far_off_headings_count_less_or_not_at_all() {
    let spread_deg = 26.0_f32.sqrt();
    let mut robot = Robot::aligned(10.0);
    for (north_deg, expected) in [
        (10.0, Some(-10.0)),
        (-12.0, Some(2.0 * spread_deg)),
        (15.0, Some(-2.0 * spread_deg)),
        (15.6, None),
        (-170.0, None),
    ] {
        let report = robot.window(north_deg, SURE);
        match expected {
            Some(expected) => {
                let got = heading_deg(report);
                assert!((got - expected).abs() < 0.01, "{north_deg}°: {got}");
            }
            None => assert!(report.heading.is_none(), "{north_deg}°"),
        }
        assert_eq!(report.added_variance_rad2, 0.0);
        assert!(report.body_ut.is_some());
    }
}

#[test]
fn an_unsure_heading_takes_the_field_more_seriously() {
    let mut robot = Robot::aligned(10.0);
    let noise = |robot: &mut Robot, heading_sd_deg: f32| {
        let heading = (heading_sd_deg * DEG) * (heading_sd_deg * DEG);
        let report = robot.window(0.0, AttitudeVariance { heading, ..SURE });
        report
            .heading
            .expect("a heading")
            .variance
            .sqrt()
            .to_degrees()
    };
    // 20° for a second, so √5 of it for 0.2 s.
    assert!((noise(&mut robot, 4.0) - 44.72).abs() < 0.01);
    assert!((noise(&mut robot, 6.0) - 10.0).abs() < 0.01);
}

#[test]
fn what_was_believed_is_doubted_after_as_long_again() {
    for (accepted_s, doubted_s) in [(2.0, 2.2), (20.0, 20.2), (300.0, 60.2)] {
        let mut robot = Robot::aligned(accepted_s);
        let after_s = robot.doubted_after_s(40.0).expect("doubt");
        assert!((after_s - doubted_s).abs() < 0.3, "{accepted_s}: {after_s}");
        // From then on the new north is refused no longer: it is doubted each time.
        let report = robot.window(40.0, SURE);
        assert!((report.added_variance_rad2.sqrt().to_degrees() - 40.0).abs() < 0.01);
        // With that doubt it is within the gate.
        let heading = (40.0 * DEG) * (40.0 * DEG);
        let report = robot.window(40.0, AttitudeVariance { heading, ..SURE });
        assert!((heading_deg(report) + 40.0).abs() < 0.01);
    }
}

#[test]
fn short_disturbances_do_not_add_up() {
    let mut robot = Robot::aligned(10.0);
    for _ in 0..20 {
        for _ in 0..20 {
            assert_eq!(robot.window(40.0, SURE).added_variance_rad2, 0.0);
        }
        robot.believe(4.0);
    }
}

/// Of the right direction, but a fifth too strong: no more than a hint that it is not the earth's.
#[test]
fn a_magnet_that_points_north_is_not_believed_either() {
    let mut robot = Robot::aligned(1.0);
    robot.strapdown.rate_rps = [0.0, 1.0, 0.0];
    robot.believe(10.0);
    let report = robot.window_of(EARTH_UT.map(|part| 1.2 * part), SURE);
    assert!(report.heading.is_none() && report.added_variance_rad2 == 0.0);
    assert!(robot.window(0.0, SURE).heading.is_none());
    robot.window(0.0, SURE);
    assert!(robot.window(0.0, SURE).heading.is_some());
}

#[test]
fn a_steep_field_has_no_direction() {
    let mut robot = Robot::aligned(10.0);
    let report = robot.window_of([0.0, 4.9, -60.0], SURE);
    assert!(
        report.heading.is_none() && report.body_ut.is_some() && report.added_variance_rad2 == 0.0
    );
}

/// Beside a loudspeaker, for as long as anyone likes, from the start or later.
#[test]
fn a_field_that_the_earth_never_has_is_never_believed() {
    let loudspeaker = [200.0, -100.0, 250.0];
    let mut robot = Robot::new();
    robot.strapdown.rate_rps = [1.0, 0.0, 0.0];
    for _ in 0..2_000 {
        let report = robot.window_of(loudspeaker, SURE);
        assert!(report.initial_heading_rad.is_none() && report.heading.is_none());
    }
    assert!(robot.window(0.0, SURE).initial_heading_rad.is_some());
    robot.believe(60.0);
    for _ in 0..2_000 {
        let report = robot.window_of(loudspeaker, SURE);
        assert!(report.heading.is_none() && report.added_variance_rad2 == 0.0);
    }
    // Back home nothing has been forgotten.
    assert!(robot.window(0.0, SURE).heading.is_some());
}

#[test]
fn a_window_without_a_sample_says_nothing() {
    let mut robot = Robot::aligned(10.0);
    let report = robot.magnetic.close_window(WINDOW_S, SURE);
    assert!(
        report.body_ut.is_none() && report.heading.is_none() && report.added_variance_rad2 == 0.0
    );
}

#[test]
fn the_field_in_the_body_is_what_was_measured() {
    let mut robot = Robot::aligned(10.0);
    let expected = robot.attitude.seen_from_body(EARTH_UT);
    let got = robot.window(0.0, SURE).body_ut.expect("a field");
    for (got, expected) in got.iter().zip(expected) {
        assert!((f64::from(*got) - expected).abs() < 1e-4);
    }
}

/// Samples that were turned into a world which has been tilted since.
#[test]
fn a_tilt_of_the_world_takes_a_half_full_window_along() {
    let mut robot = Robot::aligned(10.0);
    let seen = to_f32(robot.attitude.seen_from_body(EARTH_UT));
    for _ in 0..5 {
        robot.magnetic.feed(seen, &robot.strapdown, 0.0);
    }
    let tilt = [0.0, 0.0, 3.0 * DEG];
    robot.magnetic.rotate_world(tilt);
    robot.strapdown.rotate_world(tilt);
    for _ in 0..5 {
        robot.magnetic.feed(seen, &robot.strapdown, 0.0);
    }
    let report = robot.magnetic.close_window(WINDOW_S, SURE);
    assert!((heading_deg(report) + 3.0).abs() < 0.02);
}

/// A sample of 20 ms ago while turning at 1 rad/s, or of the future.
#[test]
fn an_old_sample_is_turned_to_the_present() {
    let mut robot = Robot::aligned(10.0);
    let truth = robot.attitude;
    robot.strapdown.rate_rps = [0.3, 0.2, 1.0];
    for ahead_s in [-0.02, 0.004] {
        let then = truth.then_in_body(Rotation::by(
            robot
                .strapdown
                .rate_rps
                .map(|rate| f64::from(rate * ahead_s)),
        ));
        for _ in 0..10 {
            let seen = then.seen_from_body(EARTH_UT);
            robot.magnetic.feed(to_f32(seen), &robot.strapdown, ahead_s);
        }
        let report = robot.magnetic.close_window(WINDOW_S, SURE);
        assert!(heading_deg(report).abs() < 0.01);
    }
}
