//! What a pilot does to see a robot stand.

use robot_host_loop::Robot;
use robot_plant::world::RemoteInput;

/// Arms a robot that has just been switched on, asks it to stand, and waits until `until_s` after power-on.
pub fn stand_up(robot: &mut Robot, until_s: f64) {
    robot.run_until(3.0, |_| ());
    robot.remote(RemoteInput {
        enable: Some(true),
        ..RemoteInput::default()
    });
    robot.run_until(3.3, |_| ());
    robot.remote(RemoteInput {
        stand: Some(true),
        ..RemoteInput::default()
    });
    robot.run_until(until_s, |_| ());
}
