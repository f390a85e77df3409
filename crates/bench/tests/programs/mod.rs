//! Finds the filters' programs for the tests.

use std::{
    env,
    path::{Path, PathBuf},
};

/// Returns the folder that `ROBOT_FILTERS` names, else the one where `cargo xtask` builds them.
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
