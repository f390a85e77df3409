//! Every file in `scenarios/dbus/` holds on the image built for a DBUS receiver.

mod support;

#[path = "support/scenario_files.rs"]
mod scenario_files;

use std::path::PathBuf;

#[test]
fn every_dbus_scenario_holds() {
    let Some(elf) = std::env::var_os("ROBOT_ELF_DBUS").map(PathBuf::from) else {
        println!("skipped: ROBOT_ELF_DBUS names no image built with ROBOT_REMOTE=dbus");
        return;
    };
    scenario_files::must_hold(&support::repository().join("scenarios/dbus"), &elf);
}
