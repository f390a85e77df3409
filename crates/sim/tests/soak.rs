//! Two emulated minutes of the soak that `cargo xtask soak` runs for hours.

#[expect(dead_code, reason = "the soak makes its machine itself")]
mod support;

use robot_plant::time::SECOND;
use robot_sim::{image_robot, soak::Soak};

#[test]
fn every_invariant_holds_for_two_minutes() {
    let elf = robot_test_support::image();
    let robot = image_robot::of_image(&elf, None);
    let soak = Soak {
        elf,
        robot: robot.expect("its file is in robots/"),
        length: 120 * SECOND,
        seed: 1,
    };
    let outcome = soak.run(|_| ()).expect("the machine starts");
    if let Some(failure) = &outcome.failure {
        panic!("{failure}\n{}", failure.scenario);
    }
    let tally = &outcome.tally;
    println!("{tally:?}");
    assert!(tally.armings >= 3 && tally.stops >= 10, "{tally:?}");
    assert!(
        tally.settings.changes >= 10 && tally.settings.restored >= 6,
        "{tally:?}"
    );
    assert!(tally.flash_erases >= 1, "{tally:?}");
    assert!(tally.most_current_ma > 0.0 && tally.most_torque_nm > 0.0);
}
