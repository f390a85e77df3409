//! `data/roboticstoolbox.json`, which `python/roboticstoolbox_values.py` wrote.

use robot_arm::kinematics::{Robot, create_so101_5dof};
use serde_json::Value;

use crate::arms;

const ALLOWED: f64 = 1e-9;

#[test]
fn poses_and_jacobians_are_those_of_roboticstoolbox() {
    let text = include_str!("../data/roboticstoolbox.json");
    let values: Value = serde_json::from_str(text).expect("JSON");
    let of = |name: &str| {
        let arms = values["arms"].as_array().expect("arms");
        let arm = arms.iter().find(|arm| arm["arm"] == name);
        arm.expect("this arm")["answers"].as_array().expect("some")
    };
    agree(&create_so101_5dof(), of("so101"));
    agree(&arms::so101(), of("so101"));
    agree(&arms::elementary(), of("elementary"));
    agree(&arms::puma560(), of("puma560"));
    agree(&arms::stanford(), of("stanford"));
    agree(&arms::panda(), of("panda"));
}

fn agree(robot: &Robot, answers: &[Value]) {
    assert!(answers.len() >= 5);
    for answer in answers {
        let q = numbers(&answer["q"]);
        let pose = robot.fkine(&q).expect("a pose").to_homogeneous();
        let jacob0 = robot.jacob0(&q).expect("a Jacobian");
        let jacobe = robot.jacobe(&q).expect("a Jacobian");
        near(robot, |row, column| pose[(row, column)], &answer["pose"]);
        near(
            robot,
            |row, column| jacob0[(row, column)],
            &answer["jacob0"],
        );
        near(
            robot,
            |row, column| jacobe[(row, column)],
            &answer["jacobe"],
        );
    }
}

fn near(robot: &Robot, ours: impl Fn(usize, usize) -> f64, theirs: &Value) {
    let rows = theirs.as_array().expect("rows");
    assert!(rows.len() >= 3);
    for (row, values) in rows.iter().enumerate() {
        for (column, theirs) in numbers(values).into_iter().enumerate() {
            let difference = (ours(row, column) - theirs).abs();
            let name = robot.name();
            assert!(
                difference < ALLOWED,
                "{name}: {difference} at {row}, {column}"
            );
        }
    }
}

fn numbers(values: &Value) -> Vec<f64> {
    let values = values.as_array().expect("a row").iter();
    values
        .map(|value| value.as_f64().expect("a number"))
        .collect()
}
