//! The Python package, installed as anybody would install it.

use std::path::{Path, PathBuf};

use robot_test_support::Python;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join("arm")
}

fn script(name: &str) -> PathBuf {
    let tests = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/python");
    tests.join(name)
}

/// The document's snippets run, errors say what the library says, and the type hints are those of the module. Then an emulated
/// arm moves.
#[test]
fn the_package_installs_and_does_what_the_document_says() {
    let Some(python) = Python::with_build() else {
        return;
    };
    let repository = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut command = python.building_command(script("package.py"));
    command.arg(repository).arg(folder());
    let said = String::from_utf8(Python::answer(command, "")).expect("text");
    assert!(said.contains("all of it runs"), "{said}");
    #[cfg(unix)]
    an_emulated_arm_moves(&python);
}

#[cfg(unix)]
fn an_emulated_arm_moves(python: &Python) {
    use robot_servo_model::{Bus, Port, Version, so101_servos};

    let bus = Bus::new(so101_servos(Version::Volts12), 16);
    let port = Port::open(bus).expect("a pseudo-terminal");
    let mut command = python.command(script("controller.py"));
    command.arg(folder().join("packages")).arg(port.path());
    command.arg(folder());
    let said = String::from_utf8(Python::answer(command, "")).expect("text");
    assert!(said.contains("the arm moved"), "{said}");
    let servos = port.bus().view();
    assert!(servos.iter().all(|servo| !servo.has_torque), "{servos:?}");
}
