//! Every file in `scenarios/` holds on the shipped image.

mod support;

#[path = "support/scenario_files.rs"]
mod scenario_files;

#[test]
fn every_scenario_holds() {
    scenario_files::must_hold(
        &robot_test_support::repository().join("scenarios"),
        &robot_test_support::image(),
    );
}
