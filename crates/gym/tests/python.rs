//! The Python package, installed as anybody would install it, and the programs of `train`.

use std::path::{Path, PathBuf};

use robot_test_support::Python;

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Gymnasium's own check passes, the vector of robots steps, and training runs, goes on and is exported.
#[test]
fn the_package_installs_and_a_policy_is_trained() {
    let Some(python) = Python::with_training() else {
        return;
    };
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("gym");
    let script = repository().join("crates/gym/tests/python/check.py");
    let mut command = python.command(script);
    command.arg(repository()).arg(&folder);
    let said = String::from_utf8(Python::answer(command, "")).expect("text");
    assert!(said.contains("all of it runs"), "{said}");
}
