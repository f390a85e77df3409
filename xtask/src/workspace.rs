//! Folders and targets of the workspace.

use std::{
    env,
    path::{Path, PathBuf},
};

/// Target triple of the firmware.
pub const BOARD: &str = "thumbv7em-none-eabihf";

/// Root of the repository.
pub fn root() -> PathBuf {
    let xtask = Path::new(env!("CARGO_MANIFEST_DIR"));
    xtask.parent().unwrap_or(xtask).to_path_buf()
}

/// Target folder of everything that runs on this machine.
pub fn host_target_dir() -> PathBuf {
    match env::var_os("CARGO_TARGET_DIR") {
        Some(dir) => env::current_dir().unwrap_or_else(|_| root()).join(dir),
        None => root().join("target"),
    }
}

/// Target folder of images. It is separate, so that an image and the emulator can be built at the same time.
pub fn firmware_target_dir(name: &str) -> PathBuf {
    host_target_dir().join(name)
}

/// Folder for the logs of builds.
pub fn log_dir() -> PathBuf {
    host_target_dir().join("xtask")
}
