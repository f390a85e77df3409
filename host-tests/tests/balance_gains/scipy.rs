//! The linear model and the gains are those of an independent model in Python with SciPy's Riccati solver.

use std::path::{Path, PathBuf};

use robot_balance_design::{LinearModel, Regulator};
use robot_description::{Carrier, Robot};
use robot_test_support::Python;

/// Largest difference, as a part of the largest entry.
const MODEL_TOLERANCE: f64 = 1e-8;
const GAIN_TOLERANCE: f64 = 1e-6;

struct Case {
    robot: &'static str,
    length_m: [f64; 2],
    com_x_m: f64,
    carrier: Carrier,
}

const CASES: [Case; 4] = [
    Case {
        robot: "fivebar",
        length_m: [0.18, 0.18],
        com_x_m: 0.0,
        carrier: Carrier::Rear,
    },
    Case {
        robot: "fivebar",
        length_m: [0.14, 0.25],
        com_x_m: 0.02,
        carrier: Carrier::Front,
    },
    Case {
        robot: "fivebar-rs00",
        length_m: [0.30, 0.20],
        com_x_m: -0.03,
        carrier: Carrier::Rear,
    },
    Case {
        robot: "fivebar-rs00",
        length_m: [0.22, 0.22],
        com_x_m: 0.0,
        carrier: Carrier::Front,
    },
];

#[test]
fn model_and_gains_are_those_of_scipy() {
    let Some(python) = Python::with_science() else {
        return;
    };
    for case in &CASES {
        let reference = reference(&python, case);
        let mut robot = Robot::read(&file(case.robot)).expect("a robot of this repository");
        robot.body.com_m[0] = case.com_x_m;
        robot.wheels.carrier = case.carrier;
        let Regulator {
            model: LinearModel { a, b, equilibrium },
            undelayed,
            gains,
            ..
        } = Regulator::new(&robot, case.length_m).expect("gains");
        // Rows one after the other, as Python prints them.
        let check = |name: &str, ours: &[f64], tolerance: f64| {
            let theirs = &reference[name];
            let largest = ours.iter().fold(0.0, |m: f64, v| m.max(v.abs())).max(1e-3);
            assert_eq!(ours.len(), theirs.len(), "{name}");
            for (index, (ours, theirs)) in ours.iter().zip(theirs).enumerate() {
                assert!(
                    (ours - theirs).abs() < tolerance * largest,
                    "{} {name}[{index}]: {ours}, SciPy {theirs}",
                    case.robot
                );
            }
        };
        check("a", a.transpose().as_slice(), MODEL_TOLERANCE);
        check("b", b.transpose().as_slice(), MODEL_TOLERANCE);
        check("lean", &[equilibrium.lean_rad], MODEL_TOLERANCE);
        check("leg_nm", &equilibrium.leg_torque_nm, MODEL_TOLERANCE);
        check("k", undelayed.transpose().as_slice(), GAIN_TOLERANCE);
        check("late", gains.transpose().as_slice(), GAIN_TOLERANCE);
    }
}

fn reference(python: &Python, case: &Case) -> std::collections::BTreeMap<String, Vec<f64>> {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/balance_gains/model.py");
    let carrier = match case.carrier {
        Carrier::Front => "front",
        Carrier::Rear => "rear",
    };
    let output = python
        .command(script)
        .arg(file(case.robot))
        .args(case.length_m.map(|length_m| length_m.to_string()))
        .arg(format!("{}", case.com_x_m))
        .arg(carrier)
        .output()
        .expect("Python starts");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    serde_json::from_slice(&output.stdout).expect("a JSON object")
}

pub fn file(robot: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../robots/{robot}.toml"))
}
