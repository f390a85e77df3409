//! Builds for the board with Debian's compiler, without rustup's servers. That compiler has no core library for the
//! board, but the package `rust-web-src` contains the sources, and cargo builds them.

use std::{
    path::{Path, PathBuf},
    process::Command,
};

use anyhow::Context;

use crate::{
    prerequisites::{self, Prerequisite},
    tool,
};

/// Minor version of `rust-version` in the workspace's `Cargo.toml`.
const OLDEST_MINOR: u32 = 95;

const COMPILER: [Prerequisite; 2] = [
    Prerequisite {
        what: "the distribution's Rust compiler with library sources",
        why: "rustup cannot fetch the board's target here",
        packages: &["rustc-web", "cargo-web", "rust-web-src"],
        present: has_compiler,
    },
    Prerequisite {
        what: "the LLVM linker",
        why: "it links the image",
        packages: &["lld"],
        present: || linker().is_some(),
    },
];

pub fn is_installed() -> bool {
    COMPILER.iter().all(|item| (item.present)())
}

pub fn install() -> anyhow::Result<()> {
    prerequisites::ensure(&COMPILER)
}

/// Returns the distribution's cargo, set up to build for the board.
pub fn cargo() -> anyhow::Result<Command> {
    let linker = linker().context("the LLVM linker is not there")?;
    let mut command = tool::command("/usr/bin/cargo");
    command
        .env("PATH", "/usr/bin:/bin")
        .env_remove("RUSTUP_TOOLCHAIN")
        .env("RUSTC", "/usr/bin/rustc")
        .env("RUSTDOC", "/usr/bin/rustdoc")
        // Building the core library is a nightly feature; the distribution ships sources that
        // match its compiler exactly, which is what the feature needs.
        .env("RUSTC_BOOTSTRAP", "1")
        .env("CARGO_TARGET_THUMBV7EM_NONE_EABIHF_LINKER", linker)
        .args(["-Z", "build-std=core"]);
    Ok(command)
}

fn has_compiler() -> bool {
    let sources = Path::new("/usr/lib/rustlib/src/rust/library/core");
    let mut rustc = tool::command("/usr/bin/rustc");
    rustc.arg("--version").env_remove("RUSTUP_TOOLCHAIN");
    sources.is_dir()
        && Path::new("/usr/bin/cargo").is_file()
        && tool::printed_by(rustc).is_ok_and(|version| is_new_enough(&version))
}

/// Reads the version from a line such as `rustc 1.96.0 (abc 2026-05-25)`.
fn is_new_enough(version: &str) -> bool {
    let minor = version.split(['.', ' ']).nth(2);
    minor.and_then(|minor| minor.parse().ok()) >= Some(OLDEST_MINOR)
}

fn linker() -> Option<PathBuf> {
    let rustup = || {
        let mut rustc = tool::command("rustc");
        rustc.args(["--print", "target-libdir"]);
        let libraries = PathBuf::from(tool::printed_by(rustc).ok()?);
        Some(libraries.parent()?.join("bin/rust-lld"))
    };
    let debian = || Some(PathBuf::from("/usr/bin/ld.lld"));
    [rustup(), debian()]
        .into_iter()
        .flatten()
        .find(|path| path.is_file())
}

#[cfg(test)]
mod tests {
    use super::is_new_enough;

    #[test]
    fn compiler_version_is_read() {
        assert!(is_new_enough("rustc 1.96.0 (ac68faa20 2026-05-25)"));
        assert!(is_new_enough("rustc 1.95.0"));
        assert!(!is_new_enough("rustc 1.63.0 (4b91a6ea7 2022-08-08)"));
        assert!(!is_new_enough("nonsense"));
    }
}
