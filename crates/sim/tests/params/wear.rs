//! The wear of a tuning session.

use robot_plant::time::{MS, SECOND};
use robot_sim::machine::flash::FlashStepKind;
use robot_test_support::is_whole;

use crate::{
    flash_image::newest,
    robot::Robot,
    settings::{GROUPS, Make, calibrated, image},
};

fn erases(robot: &Robot) -> usize {
    let steps = robot.machine.flash_steps().iter();
    steps
        .filter(|step| step.kind == FlashStepKind::Erase)
        .count()
}

/// Slots that are left in a new sector once twelve records have moved there.
const SLOTS: usize = 115;

/// A thousand changes fill nine sectors; the sample fills two.
#[test]
fn changes_saved_one_by_one_cost_an_erase_for_each_full_sector() {
    let changes: usize = if is_whole() { 1_000 } else { 2 * SLOTS };
    let mut robot = Robot::with_flash(Make::Dm4310, &image(Make::Dm4310, GROUPS));
    robot.run_for(SECOND);
    let value = |change: usize| 0.3 + change as f32 * 1e-4;
    for change in 1..=changes {
        robot.set((1, 1), value(change));
        robot
            .wait(3 * SECOND, |robot| robot.is_saved(change))
            .expect("it is saved");
    }
    robot
        .wait(2 * SECOND, Robot::is_tidy)
        .expect("it makes room");
    let erases = erases(&robot);
    let each = [1, 2, 3].map(|sector| robot.machine.flash_erases(sector));
    println!(
        "{changes} changes saved one by one in {} s: {erases} erases, {each:?} by sector",
        robot.now() / SECOND
    );
    assert_eq!(robot.diag("params.save_ok"), Some(changes as f64));
    assert_eq!(robot.diag("params.save_failed"), Some(0.0));
    assert!(erases <= changes.div_ceil(SLOTS), "{erases}");
    let stored = newest(&robot.machine.parameter_flash());
    assert_eq!(stored[&(1, 0)].values[1], value(changes).to_bits());
}

/// A whole file of settings at full speed, as `robotctl tune apply` sends it.
#[test]
fn a_file_of_settings_costs_a_record_a_group() {
    let mut robot = Robot::with_flash(Make::Dm4310, &image(Make::Dm4310, GROUPS));
    robot.run_for(SECOND);
    let mut changes = 0;
    for round in 0..10 {
        for (group, index, value) in [
            (5, 0, 0.3),
            (5, 1, 0.1),
            (6, 0, 9.0),
            (6, 1, -9.0),
            (7, 1, 0.3),
        ] {
            robot.set((group, index), value + round as f32 * 0.01);
            changes += 1;
        }
    }
    robot
        .wait(3 * SECOND, |robot| robot.is_saved(changes))
        .expect("it is saved");
    robot.run_for(500 * MS);
    println!(
        "{changes} changes in a row: {:?} records, {} erases",
        robot.diag("params.save_ok"),
        erases(&robot)
    );
    assert_eq!(robot.diag("params.save_ok"), Some(3.0));
    assert_eq!(erases(&robot), 0);
    let settings = robot.settings();
    assert_eq!(settings[&(5, 2)], calibrated()[&(5, 2)]);
    assert_eq!(settings[&(7, 1)], (0.3_f32 + 9.0 * 0.01).to_bits());
}
