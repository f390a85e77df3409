//! The optimal control of a pushed robot, `python/push_bound` (docs/decisions/push.md).

use std::path::{Path, PathBuf};

use robot_description::Robot;
use robot_plant::free::{FreeBody, FreeInputs, FreeSetup};
use robot_test_support::Python;
use serde_json::{Value, json};

/// Largest difference of an acceleration, as a part of the largest of its pose.
const TOLERANCE: f64 = 1e-6;

fn in_tree(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// What the program answers to `question`, or `None` where there is no CasADi.
fn ask(robot: &Path, args: &[&str], question: &Value) -> Option<Value> {
    let python = Python::with_optimal_control()?;
    let mut command = python.command(in_tree("python/push_bound"));
    command.arg(robot).args(args);
    let answer = Python::answer(command, &question.to_string());
    Some(serde_json::from_slice(&answer).expect("JSON"))
}

fn numbers(value: &Value) -> Vec<f64> {
    let list = value.as_array().expect("a list");
    list.iter()
        .map(|it| it.as_f64().expect("a number"))
        .collect()
}

/// Pitch, angles of the hips, torques of wheel and hips.
type Case = (f64, [f64; 2], [f64; 3]);

const CASES: [Case; 4] = [
    (0.0, [-0.3, 0.3], [1.0, 0.0, 0.0]),
    (0.3, [-0.6, 0.1], [0.0, 2.0, 0.0]),
    (-0.2, [0.1, 0.5], [0.0, 0.0, -2.0]),
    (0.1, [0.4, -0.4], [-3.0, 1.5, 0.7]),
];

#[test]
fn it_accelerates_as_the_simulated_robot() {
    for name in ["fivebar", "fivebar-rs00"] {
        let file = in_tree("../../robots").join(format!("{name}.toml"));
        let robot = Robot::read(&file).expect("a robot of this repository");
        let poses: Vec<Value> = CASES
            .iter()
            .map(|(pitch, joints, torques)| {
                json!({ "pitch_rad": pitch, "joints_rad": joints, "torques_nm": torques })
            })
            .collect();
        let Some(answers) = ask(&file, &["--accelerations"], &json!(poses)) else {
            return;
        };
        for (case, answer) in CASES.iter().zip(answers.as_array().expect("a list")) {
            let (found, expected) = (numbers(answer), simulated(&robot, case));
            let size = expected.iter().fold(0.0_f64, |most, it| most.max(it.abs()));
            let close = |(a, b): (&f64, &f64)| (a - b).abs() < TOLERANCE * size;
            assert!(
                found.iter().zip(&expected).all(close),
                "{name}, {case:?}: {found:?}, {expected:?}"
            );
        }
    }
}

/// Accelerations of the hips' centre forward and up, of pitch, of the front and the rear hips.
fn simulated(robot: &Robot, (pitch_rad, joints_rad, torques_nm): &Case) -> [f64; 5] {
    let mut body = FreeBody::new(robot, &FreeSetup::default());
    let mut state = body.state();
    let (sin, cos) = (pitch_rad / 2.0).sin_cos();
    state.attitude = [cos, 0.0, sin, 0.0];
    state.velocity_mps = [0.0; 3];
    state.rate_rps = [0.0; 3];
    state.joint_rps = [0.0; 4];
    state.wheel_rps = [0.0; 2];
    let [front, rear] = *joints_rad;
    state.joint_rad = [front, rear, front, rear];
    body.set_state(&state);
    let [wheel, front, rear] = *torques_nm;
    let found = body.rolling_accelerations(&FreeInputs {
        wheel_nm: [wheel; 2],
        joint_nm: [front, rear, front, rear],
        ..FreeInputs::default()
    });
    let [ahead, _, up] = found.linear_mps2;
    let [_, pitch, _] = found.angular_rps2;
    [ahead, up, pitch, found.joint_rps2[0], found.joint_rps2[1]]
}

/// On a coarse grid, which takes seconds.
#[test]
fn a_small_push_is_over_within_the_limits_of_ground_and_motors() {
    let file = in_tree("../../robots/fivebar.toml");
    let (friction, push) = (0.8, 0.5);
    let args = ["--json", "--push", "0.5", "--intervals", "8"];
    let Some(answer) = ask(&file, &args, &Value::Null) else {
        return;
    };
    let column = |name: &str| numbers(&answer["motion"][name]);
    let rest_s = answer["rest_s"].as_f64().expect("a time");
    println!("over after {rest_s:.2} s");
    assert!(rest_s < 0.6);
    let middle = column("middle_mps");
    assert!(middle.iter().any(|it| *it > push), "it was pushed");
    let robot = Robot::read(&file).expect("a robot");
    for (grip_n, load_n) in column("grip_n").iter().zip(column("load_n")) {
        assert!(grip_n.abs() < friction * load_n + 0.1, "{grip_n} {load_n}");
    }
    let most_nm = robot.wheels.max_current_a * robot.wheels.torque_nm_per_a;
    assert!(
        column("wheel_nm")
            .iter()
            .all(|nm| nm.abs() < most_nm + 1e-3)
    );
    for name in ["middle_mps", "axle_mps", "pitch_rad", "lean_rad"] {
        let last = *column(name).last().expect("a motion");
        assert!(last.abs() < 0.01, "{name} ends at {last}");
    }
}
