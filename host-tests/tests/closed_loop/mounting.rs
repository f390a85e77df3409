//! Every mounting of the board, and every mounting of the magnetometer on it.

use robot_app::domain::{MountingConfig, Orientation, RobotConfig};
use robot_plant::world::{PlantKind, WorldConfig};

use crate::{ENABLE, FORWARD, Robot, assert_still, blockers, sticks};

/// Names as the world understands them.
fn robot(board: &str, mag: &str, mounting: MountingConfig) -> Robot {
    let world = WorldConfig {
        plant: PlantKind::Rolling,
        mounting: Some(board.parse().expect("a mounting")),
        mag_mounting: mag.parse().expect("a mounting"),
        ..WorldConfig::default()
    };
    let config = RobotConfig {
        mounting,
        ..RobotConfig::default()
    };
    Robot::in_world(world, config).expect("there is no recording to load")
}

#[test]
fn a_robot_with_known_mounting_drives_as_usual() {
    for (index, board) in Orientation::ALL.into_iter().enumerate() {
        let mag = Orientation::ALL[(7 * index + 5) % 24];
        let name = (board.name(), mag.name());
        let mounting = MountingConfig {
            board,
            mag: Some(mag),
        };
        let mut robot = robot(board.name(), mag.name(), mounting);
        robot.run_until(2.5, assert_still);
        robot.remote(ENABLE);
        robot.run_until(2.7, |_| ());
        assert!(robot.armed(), "{name:?}: {:?}", blockers(&robot));
        robot.remote(FORWARD);
        robot.run_until(3.5, |_| ());
        robot.remote(sticks(0.0, 0.3));
        robot.run_until(4.2, |_| ());
        assert!(robot.signal("truth.body.x") > 0.25, "{name:?}");
        assert!(robot.signal("truth.body.yaw") > 0.4, "{name:?}");
        robot.fault("tilted", true);
        robot.run_until(5.0, |robot| {
            // What the accelerometer's offset (20 mg) and the magnetometer's noise leave.
            let [total_deg, ..] = robot.attitude_error_deg();
            assert!(total_deg < 6.0, "{name:?}: {total_deg}°");
        });
        let [_, pitch_rad, _] = robot.diagnostics().estimate.rpy_rad;
        assert!(
            pitch_rad > 1.0,
            "{name:?}: nose down is positive, {pitch_rad}"
        );
    }
}

/// The field is not used, even if it is wrong, and the gyro carries the heading.
#[test]
fn a_magnetometer_of_unknown_mounting_does_not_change_the_heading() {
    let mounting = MountingConfig {
        board: Orientation::XLeftZUp,
        mag: None,
    };
    let mut robot = robot("x-left-z-up", "x-backward-z-down", mounting);
    robot.run_until(2.5, assert_still);
    robot.remote(ENABLE);
    robot.run_until(2.7, |_| ());
    robot.remote(sticks(0.0, 0.3));
    robot.run_until(5.0, |robot| {
        let [total_deg, ..] = robot.attitude_error_deg();
        assert!(total_deg < 6.0, "{total_deg}°");
    });
    assert!(robot.signal("truth.body.yaw") > 1.0);
}
