//! Places of the image and the scenarios.

use std::path::{Path, PathBuf};

use robot_sim::{job::Job, pc::PcAccess, scenario::Scenario};

pub fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The release image: the file that `ROBOT_ELF` names, or the one that `cargo xtask` builds.
pub fn image() -> PathBuf {
    let built = "target/firmware/thumbv7em-none-eabihf/release/robot-firmware";
    let path =
        std::env::var_os("ROBOT_ELF").map_or_else(|| repository().join(built), PathBuf::from);
    assert!(
        path.is_file(),
        "there is no firmware image at {}: run `cargo xtask test`, which builds it, or set ROBOT_ELF",
        path.display()
    );
    path
}

pub fn job(scenario: Scenario) -> Job {
    Job {
        elf: image(),
        scenario,
        imu_trial: None,
        patches: Vec::new(),
        probe: false,
        pc: PcAccess::default(),
        flash_file: None,
    }
}
