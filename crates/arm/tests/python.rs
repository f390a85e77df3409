//! The Python package, installed as anybody would install it.

use std::path::Path;

use robot_test_support::Python;

/// The document's snippets run, errors say what the library says, and the type hints are those of the module.
#[test]
fn the_package_installs_and_does_what_the_document_says() {
    let Some(python) = Python::with_build() else {
        return;
    };
    let repository = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("arm");
    let script = repository.join("crates/arm/tests/python/package.py");
    let mut command = python.command(script);
    command.arg(repository).arg(folder);
    let said = String::from_utf8(Python::answer(command, "")).expect("text");
    assert!(said.contains("all of it runs"), "{said}");
}
