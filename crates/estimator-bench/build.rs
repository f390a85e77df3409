//! Puts the firmware's `memory.x` where the linker looks for it.
use std::{env, fs, path::PathBuf};

fn main() {
    const MEMORY: &str = "../../memory.x";
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    fs::copy(MEMORY, out.join("memory.x")).expect("memory.x is copied into OUT_DIR");
    println!("cargo:rustc-link-search={}", out.display());
    println!("cargo:rerun-if-changed={MEMORY}");
}
