//! The folder of the repository, and the firmware's image in it, for tests that boot it.

use std::path::{Path, PathBuf};

/// The folder of the repository.
pub fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The release image: the file that `ROBOT_ELF` names, or the one that `cargo xtask` builds.
///
/// # Panics
/// There is no such file.
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
