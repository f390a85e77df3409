//! Targets that the compiler of `rust-toolchain.toml` can build for.

use std::path::PathBuf;

use crate::tool;

/// True if the target's core library is installed.
pub fn has(target: &str) -> bool {
    let mut rustc = tool::command("rustc");
    rustc.args(["--print", "target-libdir", "--target", target]);
    tool::printed_by(rustc).is_ok_and(|dir| PathBuf::from(dir).is_dir())
}

/// Makes rustup fetch the target if it is missing. Returns false if that fails.
pub fn add(target: &str) -> bool {
    if has(target) {
        return true;
    }
    eprintln!("fetching the core library for {target} with rustup");
    let mut rustup = tool::command("rustup");
    rustup.args(["target", "add", target]);
    tool::succeeds(rustup) && has(target)
}
