//! Looks for the recorded motion, so that the tests that need it count as ignored where it is absent.

use std::path::{Path, PathBuf};

fn main() {
    let data = match std::env::var_os("ROBOT_DATA") {
        Some(path) => PathBuf::from(path),
        None => Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data/broad"),
    };
    let usual = data.join("hz200");
    let folder = if usual.is_dir() { usual } else { data };
    println!("cargo::rustc-check-cfg=cfg(recorded_motion)");
    println!("cargo::rerun-if-env-changed=ROBOT_DATA");
    println!("cargo::rerun-if-changed={}", folder.display());
    println!("cargo::rustc-env=RECORDED_MOTION={}", folder.display());
    if folder.is_dir() {
        println!("cargo::rustc-cfg=recorded_motion");
    }
}
