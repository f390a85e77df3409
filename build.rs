//! Puts `memory.x` where the linker looks for it, has it keep what only tools read (`src/robot_identity.rs`), and builds
//! anew for other parts (`src/config.rs`).
use std::{env, fs, path::PathBuf};

fn main() {
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    fs::copy("memory.x", out.join("memory.x")).expect("memory.x is copied into OUT_DIR");
    println!("cargo:rustc-link-search={}", out.display());
    println!("cargo:rustc-link-arg-bins=--undefined=g_robotapp_robot");
    println!("cargo:rerun-if-changed=memory.x");
    println!("cargo:rerun-if-env-changed=ROBOT_REMOTE");
}
