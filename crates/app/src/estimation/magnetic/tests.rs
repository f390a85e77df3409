//! Which headings are accepted, clipped or rejected, and when the heading becomes uncertain.

mod moving;

use super::*;
use crate::{
    estimation::strapdown::Strapdown,
    math::{
        Quaternion,
        testing::{rotation_of, to_f32},
    },
};
use robot_test_support::Rotation;

const WINDOW_S: f32 = 0.2;
const RAD: f64 = std::f64::consts::PI / 180.0;
const EARTH_UT: [f64; 3] = [0.0, 20.0, -45.0];
/// Standard deviations: tilt 0.5°, heading 1°.
const SURE: AttitudeVariance = AttitudeVariance {
    tilt: (0.5 * DEG) * (0.5 * DEG),
    heading: DEG * DEG,
};

/// A robot that stands. Its attitude is not corrected.
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
            attitude: rotation_of(strapdown.attitude),
            strapdown,
            magnetic: MagneticHeading::new(),
        }
    }

    /// A robot whose heading is aligned and has been accepted for some time.
    fn aligned(seconds: f32) -> Self {
        let mut robot = Self::new();
        let report = robot.window(0.0, SURE);
        assert!(report.initial_heading_rad.is_some());
        robot.accept(seconds);
        robot
    }

    fn accept(&mut self, seconds: f32) {
        for _ in 0..(seconds / WINDOW_S).round() as u32 {
            assert!(self.window(0.0, SURE).heading.is_some());
        }
    }

    /// Feeds ten samples of a field whose north is rotated to the left by `north_deg`.
    fn window(&mut self, north_deg: f64, known: AttitudeVariance) -> HeadingReport {
        let field = Rotation::by([0.0, 0.0, north_deg * RAD]).turn(EARTH_UT);
        self.window_of(field, known)
    }

    fn window_of(&mut self, field_enu_ut: [f64; 3], known: AttitudeVariance) -> HeadingReport {
        for _ in 0..10 {
            let seen = self.attitude.seen_from_body(field_enu_ut);
            self.magnetic.feed(to_f32(seen), &self.strapdown, 0.0);
        }
        self.magnetic.close_window(WINDOW_S, known)
    }

    /// Time in s after which another north adds variance to the heading.
    fn variance_added_after_s(&mut self, north_deg: f64) -> Option<f32> {
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
fn the_first_sample_and_the_first_window_align_the_heading() {
    let mut robot = Robot::new();
    let seen = robot
        .attitude
        .seen_from_body(Rotation::by([0.0, 0.0, -100.0 * RAD]).turn(EARTH_UT));
    // North seems to lie 100° to the right, so the robot must turn by that to the left.
    let turn = robot.magnetic.feed(to_f32(seen), &robot.strapdown, 0.0);
    assert!((turn.expect("a turn").to_degrees() - 100.0).abs() < 0.01);
    let report = robot.window(-3.0, SURE);
    let first = report.initial_heading_rad.expect("a heading").to_degrees();
    assert!((first - 3.0).abs() < 0.01, "{first}");
    assert!(report.heading.is_none());
    // From then on the heading is measured, not aligned.
    let report = robot.window(-3.0, SURE);
    assert!(report.initial_heading_rad.is_none());
    assert!((heading_deg(report) - 3.0).abs() < 0.01);
}

#[test]
fn the_heading_is_aligned_again_until_the_tilt_is_known() {
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
    // Later too, a field is used only while the tilt is known.
    let report = robot.window(0.0, unsure);
    assert!(report.initial_heading_rad.is_none() && report.heading.is_none());
    assert!(robot.window(0.0, SURE).heading.is_some());
}

#[test]
fn a_north_to_the_left_is_a_heading_error_to_the_right() {
    let mut robot = Robot::aligned(10.0);
    assert!((heading_deg(robot.window(5.0, SURE)) + 5.0).abs() < 0.01);
    assert!((heading_deg(robot.window(-5.0, SURE)) - 5.0).abs() < 0.01);
}

/// The disturbance of 5° and the heading's own 1° make a standard deviation of 5.1°: clipped at two of them, rejected
/// at three.
#[test]
fn large_innovations_are_clipped_or_rejected() {
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
fn an_uncertain_heading_is_measured_with_less_noise() {
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
    // 20° over one second are √5 times as much over 0.2 s.
    assert!((noise(&mut robot, 4.0) - 44.72).abs() < 0.01);
    assert!((noise(&mut robot, 6.0) - 10.0).abs() < 0.01);
}

#[test]
fn a_contradicting_field_is_rejected_for_as_long_as_the_old_one_was_accepted() {
    for (accepted_s, expected_s) in [(2.0, 2.2), (20.0, 20.2), (300.0, 60.2)] {
        let mut robot = Robot::aligned(accepted_s);
        let after_s = robot.variance_added_after_s(40.0).expect("added variance");
        assert!(
            (after_s - expected_s).abs() < 0.3,
            "{accepted_s}: {after_s}"
        );
        // From then on the new north is rejected no longer, but adds variance each time.
        let report = robot.window(40.0, SURE);
        assert!((report.added_variance_rad2.sqrt().to_degrees() - 40.0).abs() < 0.01);
        // With that variance it passes the gate.
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
        robot.accept(4.0);
    }
}

/// The direction is right, but the field is stronger by a fifth.
#[test]
fn a_magnet_that_points_north_is_rejected() {
    let mut robot = Robot::aligned(1.0);
    robot.strapdown.rate_rps = [0.0, 1.0, 0.0];
    robot.accept(10.0);
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

/// Near a loudspeaker, from the start or later.
#[test]
fn a_field_too_strong_for_the_earth_is_never_accepted() {
    let loudspeaker = [200.0, -100.0, 250.0];
    let mut robot = Robot::new();
    robot.strapdown.rate_rps = [1.0, 0.0, 0.0];
    for _ in 0..2_000 {
        let report = robot.window_of(loudspeaker, SURE);
        assert!(report.initial_heading_rad.is_none() && report.heading.is_none());
    }
    assert!(robot.window(0.0, SURE).initial_heading_rad.is_some());
    robot.accept(60.0);
    for _ in 0..2_000 {
        let report = robot.window_of(loudspeaker, SURE);
        assert!(report.heading.is_none() && report.added_variance_rad2 == 0.0);
    }
    // Away from it, the old reference is still there.
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

/// The samples of the window were rotated to a world that has been corrected since.
#[test]
fn a_rotation_of_the_world_rotates_a_half_full_window() {
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

/// A sample of 20 ms ago at 1 rad/s, and one that is newer than the IMU sample.
#[test]
fn a_sample_is_rotated_by_the_attitude_at_its_time() {
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
