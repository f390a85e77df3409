//! Hard iron is told from magnets in the room by rotating the robot.

use super::*;
use crate::math::testing::to_f32;
use robot_test_support::{Random, Rotation};

const EARTH_UT: [f64; 3] = [0.0, 20.0, -45.0];
const WINDOW_S: f32 = 0.2;

struct Robot {
    hard_iron: HardIron,
    carried_ut: [f64; 3],
    /// Disturbance in the room, ENU.
    passing_ut: [f64; 3],
    random: Random,
    time_s: f64,
}

impl Robot {
    fn new(carried_ut: [f64; 3]) -> Self {
        Self {
            hard_iron: HardIron::new(),
            carried_ut,
            passing_ut: [0.0; 3],
            random: Random::new(11),
            time_s: 0.0,
        }
    }

    /// Feeds windows of 0.2 s. `attitude` is a function of time.
    fn run(&mut self, seconds: f64, attitude: impl Fn(f64) -> Rotation) {
        let windows = (seconds / f64::from(WINDOW_S)).round() as u32;
        for _ in 0..windows {
            self.time_s += f64::from(WINDOW_S);
            let attitude = attitude(self.time_s);
            let applied = self.hard_iron.compensation_ut().map(f64::from);
            let left_in = std::array::from_fn(|axis| self.carried_ut[axis] - applied[axis]);
            let turned = attitude.turn(left_in);
            let noise = self.random.vector(0.2);
            let field: [f64; 3] = std::array::from_fn(|axis| {
                EARTH_UT[axis] + self.passing_ut[axis] + turned[axis] + noise[axis]
            });
            let level = field[0].hypot(field[1]);
            self.hard_iron.update(
                to_f32(field),
                level as f32,
                attitude.rows().map(to_f32),
                WINDOW_S,
            );
        }
    }

    fn found_ut(&self) -> [f64; 3] {
        self.hard_iron.compensation_ut().map(f64::from)
    }

    fn error_ut(&self) -> f64 {
        let found = self.found_ut();
        let squares = (0..3).map(|axis| (found[axis] - self.carried_ut[axis]).powi(2));
        squares.sum::<f64>().sqrt()
    }
}

/// Rolls, pitches and yaws at once.
fn tumbling(t: f64) -> Rotation {
    Rotation::by([0.0, 0.0, 0.9 * t])
        .then_in_body(Rotation::by([0.0, 1.1 * (0.7 * t).sin(), 0.0]))
        .then_in_body(Rotation::by([1.3 * (0.5 * t).sin(), 0.0, 0.0]))
}

/// Yaws only.
fn driving(t: f64) -> Rotation {
    Rotation::by([0.0, 0.0, 0.9 * t])
}

#[test]
fn hard_iron_is_found_in_motion() {
    for carried_ut in [
        [10.0, 0.0, 0.0],
        [0.0, -10.0, 0.0],
        [0.0, 0.0, 10.0],
        [6.0, -7.0, 5.0],
    ] {
        let mut robot = Robot::new(carried_ut);
        robot.run(120.0, tumbling);
        println!("{carried_ut:?}: {:.1?}", robot.found_ut());
        // Of 10 µT, the compensation leaves (4 µT)² / 10 µT.
        assert!(
            robot.error_ut() < 2.5,
            "{carried_ut:?}: {:?}",
            robot.found_ut()
        );
    }
}

#[test]
fn the_residual_of_a_calibration_is_not_compensated() {
    let mut robot = Robot::new([2.0, -1.5, 1.0]);
    robot.run(120.0, tumbling);
    assert_eq!(robot.found_ut(), [0.0; 3]);
}

#[test]
fn without_rotation_nothing_is_found() {
    let mut robot = Robot::new([15.0, -10.0, 20.0]);
    robot.run(600.0, |_| Rotation::by([0.1, 0.2, 0.3]));
    assert_eq!(robot.found_ut(), [0.0; 3]);
}

/// The robot only balances, in a room whose field differs by a few µT from place to place.
#[test]
fn too_little_rotation_shows_next_to_nothing() {
    let mut robot = Robot::new([0.0; 3]);
    let mut places = Random::new(7);
    let mut worst_ut = 0.0_f64;
    for _ in 0..60 {
        robot.passing_ut = places.vector(1.5);
        let [roll, pitch, _] = places.vector(0.04);
        robot.run(10.0, |t| Rotation::by([roll, pitch + 0.04 * t.sin(), 0.0]));
        worst_ut = worst_ut.max(robot.error_ut());
    }
    println!("{worst_ut:.2} µT");
    assert!(worst_ut < 3.0, "{worst_ut}");
}

/// If the robot only yaws, vertical hard iron cannot be told from the earth's field.
#[test]
fn yaw_alone_shows_only_horizontal_hard_iron() {
    let mut robot = Robot::new([0.0, 0.0, 20.0]);
    robot.run(300.0, driving);
    assert_eq!(robot.found_ut(), [0.0; 3]);
    // Its horizontal part can, but is compensated less while the vertical part is uncertain.
    let mut robot = Robot::new([12.0, 0.0, 20.0]);
    robot.run(300.0, driving);
    let [x, y, z] = robot.found_ut();
    assert!(
        (4.0..8.0).contains(&x) && y.abs() < 0.5 && z.abs() < 0.5,
        "{x} {y} {z}"
    );
}

#[test]
fn a_passing_magnet_is_not_hard_iron() {
    let mut robot = Robot::new([0.0; 3]);
    robot.run(60.0, tumbling);
    for passing_ut in [
        [20.0, 0.0, 0.0],
        [0.0, 80.0, 0.0],
        [-60.0, -60.0, 25.0],
        [0.0, 0.0, -90.0],
    ] {
        robot.passing_ut = passing_ut;
        robot.run(10.0, tumbling);
        // The robot stops beside the magnet.
        let standing = tumbling(robot.time_s);
        robot.run(20.0, |_| standing);
        assert_eq!(robot.found_ut(), [0.0; 3], "{passing_ut:?}");
        robot.passing_ut = [0.0; 3];
        robot.run(20.0, tumbling);
        assert_eq!(robot.found_ut(), [0.0; 3], "{passing_ut:?}");
    }
}

#[test]
fn hard_iron_survives_a_passing_magnet() {
    let mut robot = Robot::new([10.0, 0.0, 0.0]);
    robot.run(120.0, tumbling);
    robot.passing_ut = [90.0, 0.0, 40.0];
    robot.run(10.0, tumbling);
    robot.passing_ut = [0.0; 3];
    robot.run(60.0, tumbling);
    assert!(robot.error_ut() < 2.5, "{:?}", robot.found_ut());
}
