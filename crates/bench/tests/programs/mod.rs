//! The place of the filters' programs.

use std::{
    env,
    path::{Path, PathBuf},
};

/// The folder that `ROBOT_FILTERS` names, or the one in which `cargo xtask` builds them.
pub fn folder() -> PathBuf {
    let built = "../../target/robot-estimator-bench/thumbv7em-none-eabihf/release";
    let usual = || Path::new(env!("CARGO_MANIFEST_DIR")).join(built);
    let folder = env::var_os("ROBOT_FILTERS").map_or_else(usual, PathBuf::from);
    assert!(
        folder.is_dir(),
        "there are no filters at {}: run `cargo xtask test`, which builds them, or set ROBOT_FILTERS",
        folder.display()
    );
    folder
}
