//! Questions to MuJoCo.

use std::{
    fs,
    path::{Path, PathBuf},
};

use robot_description::Robot;
use robot_plant::free::{FreeInputs, FreeState, Hold};
use robot_test_support::Python;
use serde_json::{Value, json};

/// A robot in MuJoCo.
pub struct Oracle {
    python: Python,
    files: [PathBuf; 2],
}

/// A robot of the tree.
pub fn robot(name: &str) -> Robot {
    let robots = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots");
    Robot::read(&robots.join(format!("{name}.toml"))).expect("a robot")
}

impl Oracle {
    /// MuJoCo with a robot, or `None` where there is no MuJoCo. `test` keeps the files of tests apart.
    pub fn new(robot: &Robot, test: &str) -> Option<Self> {
        let python = Python::with_science()?;
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
        let write = |hold, kind: &str| {
            let file = folder.join(format!("{test}-{}-{kind}.xml", robot.name));
            fs::write(&file, robot.mjcf(hold)).expect("a folder for it");
            file
        };
        let files = [
            write(robot_description::Hold::Free, "free"),
            write(robot_description::Hold::Clamped, "clamped"),
        ];
        Some(Self { python, files })
    }

    /// What the script answers.
    pub fn ask(&self, hold: Hold, task: &str, mut question: Value) -> Value {
        question["hold"] = json!(format!("{hold:?}"));
        question["task"] = json!(task);
        let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/mujoco/oracle.py");
        let mut command = self.python.command(script);
        command.args(&self.files);
        let answer = Python::answer(command, &question.to_string());
        serde_json::from_slice(&answer).expect("JSON")
    }
}

/// A state as the script reads it.
pub fn state_json(state: &FreeState) -> Value {
    json!({
        "position_m": state.position_m,
        "attitude": state.attitude,
        "velocity_mps": state.velocity_mps,
        "rate_rps": state.rate_rps,
        "joint_rad": state.joint_rad,
        "joint_rps": state.joint_rps,
        "wheel_rad": state.wheel_rad,
        "wheel_rps": state.wheel_rps,
    })
}

/// Torques and a push as the script reads them.
pub fn inputs_json(inputs: &FreeInputs) -> Value {
    let push = inputs
        .push
        .map(|push| json!({ "force_n": push.force_n, "at_m": push.at_m }));
    json!({ "joint_nm": inputs.joint_nm, "wheel_nm": inputs.wheel_nm, "push": push })
}

/// The numbers of a list.
pub fn numbers(value: &Value) -> Vec<f64> {
    let list = value.as_array().expect("a list");
    list.iter()
        .map(|it| it.as_f64().expect("a number"))
        .collect()
}
