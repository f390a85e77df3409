//! The Python example of docs/pc-link.md sends and reads the golden frames, and drives as it promises.

use std::path::Path;

use robot_test_support::Python;

#[test]
fn the_example_speaks_the_documents_frames() {
    let Some(python) = Python::with_packages() else {
        return;
    };
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let output = python
        .command(here.join("tests/python_example/check.py"))
        .arg(here.join("../examples"))
        .arg(here.join("tests/golden_frames/vectors"))
        .output()
        .expect("Python starts");
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    let complained = String::from_utf8_lossy(&output.stderr).into_owned();
    let last = said.lines().last();
    assert_eq!(last, Some("as in the golden frames"), "{complained}");
}
