//! Recorded motion played through the sensor models into the shipped image.

mod support;

use std::path::PathBuf;

use robot_emulator::sim::scenario::Scenario;

/// The twelve trials, where this computer has them.
fn recordings() -> Option<PathBuf> {
    let data = std::env::var_os("ROBOT_DATA").map_or_else(
        || support::repository().join("../shared/data"),
        PathBuf::from,
    );
    let folder = data.join("broad/hz200");
    folder.is_dir().then_some(folder)
}

/// Slow rotation in an undisturbed field: movement starts at 40 s, so 60 s have 20 s to score.
#[test]
fn the_attitude_follows_a_recorded_rotation() {
    let Some(folder) = recordings() else {
        println!("skipped: no recorded trials at ../shared/data/broad (set ROBOT_DATA)");
        return;
    };
    let text = "name = \"replay\"\nseconds = 60\nplant = \"stand\"\n";
    let mut job = support::job(Scenario::parse(text, "replay").expect("it parses"));
    job.imu_trial = Some(folder.join("02_undisturbed_slow_rotation_B.json"));
    let outcome = job.run(&mut []).expect("the machine starts");
    assert!(outcome.summary.ok, "{:?}", outcome.summary.board_errors);
    let error = outcome
        .summary
        .attitude_error
        .expect("something was scored");
    println!("{error:?}");
    assert!(
        (10_000..20_000).contains(&error.samples),
        "scored {} ms, the movement phase has 19 s",
        error.samples
    );
    assert!(
        error.inclination_rmse_deg < 2.0,
        "inclination off by {:.2}° RMSE",
        error.inclination_rmse_deg
    );
}
