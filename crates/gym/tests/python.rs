//! The Python package, installed as anybody would install it, and the programs of `train`.

use std::{fs, path::Path};

use robot_description::{Hold, JointMotor};
use robot_plant::robots;
use robot_test_support::{Python, repository};

/// Gymnasium's own check passes, the vector of robots steps, and training runs, goes on and is exported.
#[test]
fn the_package_installs_and_a_policy_is_trained() {
    let Some(python) = Python::with_training() else {
        return;
    };
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("gym");
    let script = repository().join("crates/gym/tests/python/check.py");
    let mut command = python.building_command(script);
    command.arg(repository()).arg(&folder);
    let said = String::from_utf8(Python::answer(command, "")).expect("text");
    assert!(said.contains("all of it runs"), "{said}");
}

/// The policy of the tree stands, drives, turns and takes two pushes in MuJoCo, where it was not trained.
#[test]
fn the_policy_drives_in_mujoco() {
    let Some(python) = Python::with_training() else {
        return;
    };
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join("fivebar.xml");
    let robot = robots::with_joints(JointMotor::Dm4310);
    fs::write(&file, robot.mjcf(Hold::Free)).expect("a folder for it");
    let mut command = python.command(repository().join("train/sim_to_sim.py"));
    command
        .arg(file)
        .arg(repository().join("policy/fivebar/flat/policy.onnx"));
    let said = String::from_utf8(Python::answer(command, "")).expect("text");
    assert!(said.contains("stays up for 25.0 s"), "{said}");
}
