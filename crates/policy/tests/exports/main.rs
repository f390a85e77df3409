//! Exports of other trainers: what a policy sees and commands is what a script with NumPy computes from the formulas.

use std::{collections::BTreeMap, fs, path::Path};

use robot_policy::{
    PolicyDescription,
    action::{Decoder, Target},
    attitude::{QuatWxyz, QuatXyzw},
    config,
    observation::{Commands, Layout, Observer, Reading},
};
use robot_test_support::Python;
use serde::Deserialize;

/// Relative to the larger of the value and 1.
const TOLERANCE: f64 = 1e-6;
const FILES: [&str; 7] = [
    "policies/fivebar/base.yaml",
    "policies/fivebar/lab/deploy.yaml",
    "policies/three/base.yaml",
    "policies/three/lab/params/deploy.yaml",
    "metadata.json",
    "fivebar-lab.json",
    "fivebar-tracked.json",
];

#[derive(Deserialize)]
struct Step {
    xyzw: [f32; 4],
    body_rates_rps: [f32; 3],
    commands: [f32; 3],
    motor_angles_rad: Vec<f32>,
    motor_speeds_rps: Vec<f32>,
    output: Vec<f32>,
    expected: Expected,
}

#[derive(Deserialize)]
struct Expected {
    input: Vec<f64>,
    motor_targets: Vec<f64>,
}

fn exports() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/exports"))
}

fn metadata() -> BTreeMap<String, String> {
    let text = fs::read_to_string(exports().join("metadata.json")).expect("a file");
    serde_json::from_str(&text).expect("metadata")
}

fn tracked(metadata: &BTreeMap<String, String>) -> Result<PolicyDescription, config::ConfigError> {
    config::from_metadata(&exports().join("policies"), "fivebar", "tracked", metadata)
}

fn read(robot: &str, name: &str) -> PolicyDescription {
    config::read(&exports().join("policies"), robot, name).expect("a policy")
}

fn assert_near(found: &[f32], expected: &[f64], what: &str) {
    assert_eq!(found.len(), expected.len(), "{what}");
    for (index, (found, expected)) in found.iter().zip(expected).enumerate() {
        let error = (f64::from(*found) - expected).abs() / expected.abs().max(1.0);
        assert!(
            error <= TOLERANCE,
            "{what} {index}: {found} instead of {expected}"
        );
    }
}

fn in_policy_order(policy: &PolicyDescription, motors: &[f32]) -> Vec<f32> {
    let mut joints = vec![0.0; motors.len()];
    policy.mapping.policy_from_motors(motors, &mut joints);
    joints
}

fn motor_targets(policy: &PolicyDescription, targets: &[Target]) -> Vec<f32> {
    let mapping = &policy.mapping;
    let placed = mapping.motors().iter().zip(mapping.directions());
    let mut motors = vec![0.0; targets.len()];
    for (target, (motor, direction)) in targets.iter().zip(placed) {
        motors[*motor] = match target {
            Target::Position { rad, .. } => direction * rad,
            Target::Speed { rps, .. } => direction * rps,
        };
    }
    motors
}

fn check(policy: &PolicyDescription, vectors: &str) {
    let text = fs::read_to_string(exports().join(vectors)).expect("a file");
    let steps: Vec<Step> = serde_json::from_str(&text).expect("steps");
    let mut observer = Observer::new(policy);
    let mut decoder = Decoder::new(policy);
    for (index, step) in steps.iter().enumerate() {
        let reading = Reading {
            attitude: QuatWxyz::from(QuatXyzw::new(step.xyzw).expect("an attitude")),
            body_rates_rps: step.body_rates_rps,
            linear_velocity_mps: None,
            joint_pos_rad: in_policy_order(policy, &step.motor_angles_rad),
            joint_vel_rps: in_policy_order(policy, &step.motor_speeds_rps),
        };
        let [forward_mps, left_mps, yaw_rps] = step.commands;
        let commands = Commands {
            forward_mps,
            left_mps,
            yaw_rps,
        };
        let input = observer.observe(&reading, &commands, decoder.last_actions());
        let what = |what: &str| format!("{vectors}, step {index}, {what}");
        assert_near(
            input.expect("an input"),
            &step.expected.input,
            &what("input"),
        );
        let targets = decoder.decode(&step.output).expect("targets");
        let targets = motor_targets(policy, targets);
        assert_near(
            &targets,
            &step.expected.motor_targets,
            &what("target of motor"),
        );
    }
}

#[test]
fn a_deploy_yaml_means_what_the_script_says() {
    let policy = read("fivebar", "lab");
    check(&policy, "fivebar-lab.json");
    let names: Vec<_> = policy
        .joints
        .iter()
        .map(|joint| joint.name.as_str())
        .collect();
    let in_order_of_actions = [
        "left_front_hip",
        "right_front_hip",
        "left_rear_hip",
        "right_rear_hip",
        "left_wheel",
        "right_wheel",
    ];
    assert_eq!(names, in_order_of_actions);
    // Gains of the export are in the order of the motors.
    let kp: Vec<_> = policy.joints.iter().map(|joint| joint.kp).collect();
    assert_eq!(kp, [20.0, 22.0, 21.0, 23.0, 0.0, 0.0]);
    assert_eq!(policy.decimation, 4);
}

#[test]
fn a_slice_of_all_joints_is_all_of_them() {
    let policy = read("three", "lab");
    assert_eq!(policy.mapping.motors(), [2, 0, 1]);
    assert_eq!(policy.decimation, 2);
    assert_eq!(policy.model_file, "exported/policy.onnx");
    let layout = Layout::new(&policy);
    let ages: Vec<_> = layout.blocks().iter().map(|block| block.age).collect();
    assert_eq!(ages, [4, 3, 2, 1, 0]);
}

#[test]
fn metadata_mean_what_the_script_says() {
    let policy = tracked(&metadata()).expect("a policy");
    check(&policy, "fivebar-tracked.json");
}

#[test]
fn what_metadata_lack_or_cannot_mean_is_named() {
    for (key, value, complaint) in [
        (
            "observation_names",
            "motion_anchor_ori_b",
            "observation_history_lengths: 6 values, and it has to have 1",
        ),
        (
            "observation_names",
            "command,a,b,c,d,e",
            "the term a is unknown",
        ),
        ("command_names", "motion", "recorded motion"),
        ("joint_names", "hip,b,c,d,e,f", "knows no hip"),
        (
            "action_scale",
            "1,2,3,4,5,x",
            "action_scale: \"x\" is no number",
        ),
        (
            "default_joint_pos",
            "0,0,nan,0,0,0",
            "left_front_hip: its default angle is NaN",
        ),
        ("joint_damping", "1,1,1,-1,1,1", "its damping is -1"),
        (
            "joint_stiffness",
            "1,1,1,1,1,1",
            "left_wheel is a wheel with a stiffness of 1",
        ),
        (
            "observation_names",
            "command,joint_pos,a,b,c,d",
            "the angle of left_wheel, a wheel",
        ),
    ] {
        let mut metadata = metadata();
        metadata.insert(key.to_owned(), value.to_owned());
        let error = tracked(&metadata).expect_err(key).to_string();
        assert!(error.contains(complaint), "{error}");
        metadata.remove(key);
        let error = tracked(&metadata).expect_err(key).to_string();
        assert!(error.contains(key), "{error}");
    }
}

#[test]
fn the_script_writes_the_files_that_are_here() {
    let Some(python) = Python::with_science() else {
        return;
    };
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("exports");
    fs::create_dir_all(&folder).expect("a folder");
    let script = exports().join("make.py");
    let mut command = python.command(script);
    command.arg(&folder);
    Python::answer(command, "");
    for file in FILES {
        let here = fs::read_to_string(exports().join(file)).expect("a file");
        let made = fs::read_to_string(folder.join(file)).expect("a file");
        assert!(here == made, "{file} is not what make.py writes");
    }
}
