//! The same calls with the same seed give the same run, bit for bit.

mod pilot;

use robot_app::domain::RobotConfig;
use robot_host_loop::Robot;
use robot_plant::world::{PlantKind, WorldConfig};

/// Every byte sent on CAN while a free robot sits, is armed and asked to stand, and where its body is after that.
fn run(seed: u64) -> (u64, [u64; 3]) {
    let world = WorldConfig {
        plant: PlantKind::Free,
        seed,
        ..WorldConfig::default()
    };
    let mut robot = Robot::in_world(world, RobotConfig::default()).expect("no recording to load");
    pilot::stand_up(&mut robot, 4.5);
    assert!(robot.sent_digest() != 0);
    let place = ["truth.body.x", "truth.body.z", "truth.body.pitch"];
    (
        robot.sent_digest(),
        place.map(|name| robot.signal(name).to_bits()),
    )
}

#[test]
fn a_run_depends_on_its_seed_alone() {
    let first = run(1);
    assert_eq!(first, run(1));
    assert_ne!(first, run(2));
}
