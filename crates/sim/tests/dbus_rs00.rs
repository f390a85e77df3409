//! Every file in `scenarios/dbus-rs00/` holds on the image built for a DBUS receiver and RS00 joints.

mod support;

#[path = "support/scenario_files.rs"]
mod scenario_files;

use std::path::PathBuf;

#[test]
fn every_scenario_with_dbus_and_rs00_holds() {
    let Some(elf) = std::env::var_os("ROBOT_ELF_DBUS_RS00").map(PathBuf::from) else {
        println!(
            "skipped: ROBOT_ELF_DBUS_RS00 names no image built with ROBOT_REMOTE=dbus ROBOT=fivebar-rs00"
        );
        return;
    };
    scenario_files::must_hold(
        &robot_test_support::repository().join("scenarios/dbus-rs00"),
        &elf,
    );
}
