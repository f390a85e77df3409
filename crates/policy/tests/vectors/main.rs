//! What a policy sees and commands is what a script with NumPy computes from the formulas, for each form of configuration.

use std::{fs, path::Path};

use robot_policy::{
    JointMapping, PolicyDescription,
    action::{Decoder, Target},
    attitude::{QuatWxyz, QuatXyzw},
    config,
    observation::{Commands, Observer, Reading},
};
use robot_test_support::Python;
use serde::Deserialize;
use serde_json::Value;

const POLICIES: [(&str, &str, usize); 12] = [
    ("fivebar", "flat", 69),
    ("fivebar", "flat-by-term", 72),
    ("two-wheels", "plain", 33),
    ("two-wheels", "clipped", 33),
    ("two-wheels", "unclipped", 33),
    ("legs", "newest-first", 270),
    ("legs", "by-term", 135),
    ("legs", "with-gaps", 135),
    ("legs", "velocity", 48),
    ("legs-and-wheels", "oldest-first", 570),
    ("person", "overriding", 93),
    ("mirrored", "flat", 12),
];
/// Relative to the larger of the value and 1.
const TOLERANCE: f64 = 1e-6;
/// Torques are differences of products as large as this, in N·m: the stiffness times 1 rad.
const STIFFEST: f64 = 20.0;

#[derive(Deserialize)]
struct Step {
    starts: bool,
    xyzw: [f32; 4],
    world_rates_rps: [f32; 3],
    linear_velocity_mps: [f32; 3],
    commands: [f32; 3],
    motor_angles_rad: Vec<f32>,
    motor_speeds_rps: Vec<f32>,
    output: Vec<f32>,
    expected: Expected,
}

#[derive(Deserialize)]
struct Expected {
    input: Vec<f64>,
    actions: Vec<f64>,
    targets: Vec<f64>,
    torques_nm: Vec<f64>,
}

fn vectors() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/vectors"))
}

fn policy(robot: &str, name: &str) -> PolicyDescription {
    config::read(&vectors().join("policies"), robot, name).expect("a policy")
}

fn steps(robot: &str, name: &str) -> Vec<Step> {
    let file = vectors().join(format!("{robot}-{name}.json"));
    serde_json::from_str(&fs::read_to_string(file).expect("a file")).expect("steps")
}

fn in_policy_order(mapping: &JointMapping, motors: &[f32]) -> Vec<f32> {
    let mut joints = vec![0.0; motors.len()];
    mapping.policy_from_motors(motors, &mut joints);
    joints
}

fn reading(policy: &PolicyDescription, step: &Step) -> Reading {
    let attitude = QuatWxyz::from(QuatXyzw::new(step.xyzw).expect("an attitude"));
    Reading {
        attitude,
        body_rates_rps: attitude.body_from_world(step.world_rates_rps),
        linear_velocity_mps: Some(step.linear_velocity_mps),
        joint_pos_rad: in_policy_order(&policy.mapping, &step.motor_angles_rad),
        joint_vel_rps: in_policy_order(&policy.mapping, &step.motor_speeds_rps),
    }
}

fn assert_near(found: &[f32], expected: &[f64], what: &str) {
    assert_near_with(found, expected, 1.0, what);
}

/// `size` is the size of what the values were summed from.
fn assert_near_with(found: &[f32], expected: &[f64], size: f64, what: &str) {
    assert_eq!(found.len(), expected.len(), "{what}");
    for (index, (found, expected)) in found.iter().zip(expected).enumerate() {
        let error = (f64::from(*found) - expected).abs() / expected.abs().max(size);
        assert!(
            error <= TOLERANCE,
            "{what} {index}: {found} instead of {expected}"
        );
    }
}

/// The targets' values, and their torques with the limit.
fn values(policy: &PolicyDescription, targets: &[Target], reading: &Reading) -> [Vec<f32>; 2] {
    let value = |target: &Target| match target {
        Target::Position { rad, .. } => *rad,
        Target::Speed { rps, .. } => *rps,
    };
    let torques = targets.iter().zip(&policy.joints).enumerate();
    let torques = torques.map(|(n, (target, joint))| {
        let [angle_rad, speed_rps] = [reading.joint_pos_rad[n], reading.joint_vel_rps[n]];
        let limited = target.within_torque(joint.torque_limit_nm, angle_rad, speed_rps);
        limited.torque_nm(angle_rad, speed_rps)
    });
    [targets.iter().map(value).collect(), torques.collect()]
}

#[test]
fn inputs_and_targets_are_those_of_the_script() {
    for (robot, name, length) in POLICIES {
        let policy = policy(robot, name);
        let mut observer = Observer::new(&policy);
        let mut decoder = Decoder::new(&policy);
        assert_eq!(observer.layout().len(), length, "{robot}/{name}");
        for (index, step) in steps(robot, name).iter().enumerate() {
            let what = |what: &str| format!("{robot}/{name}, step {index}, {what}");
            if step.starts {
                observer.reset();
                decoder.reset();
            }
            let reading = reading(&policy, step);
            let [forward_mps, left_mps, yaw_rps] = step.commands;
            let commands = Commands {
                forward_mps,
                left_mps,
                yaw_rps,
            };
            let input = observer.observe(&reading, &commands, decoder.last_actions());
            assert_near(
                input.expect("an input"),
                &step.expected.input,
                &what("input"),
            );
            let targets = decoder.decode(&step.output).expect("targets");
            let [targets, torques] = values(&policy, targets, &reading);
            assert_near(&targets, &step.expected.targets, &what("target"));
            assert_near_with(
                &torques,
                &step.expected.torques_nm,
                STIFFEST,
                &what("torque"),
            );
            assert_near(
                decoder.last_actions(),
                &step.expected.actions,
                &what("action"),
            );
        }
    }
}

/// True if both hold the same but for the last digits of numbers, which NumPy rounds differently on different processors.
fn is_near(here: &Value, made: &Value) -> bool {
    match (here, made) {
        (Value::Array(here), Value::Array(made)) => {
            here.len() == made.len() && here.iter().zip(made).all(|(a, b)| is_near(a, b))
        }
        (Value::Object(here), Value::Object(made)) => {
            let is_same = |(name, it)| made.get(name).is_some_and(|other| is_near(it, other));
            here.len() == made.len() && here.iter().all(is_same)
        }
        (Value::Number(here), Value::Number(made)) => match (here.as_f64(), made.as_f64()) {
            (Some(here), Some(made)) => (here - made).abs() <= 1e-12 * (1.0 + here.abs()),
            _ => false,
        },
        _ => here == made,
    }
}

#[test]
fn the_script_writes_the_files_that_are_here() {
    let Some(python) = Python::with_science() else {
        return;
    };
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("vectors");
    fs::create_dir_all(&folder).expect("a folder");
    let script = vectors().join("make.py");
    let mut command = python.command(script);
    command.arg(&folder);
    Python::answer(command, "");
    for (robot, name, _) in POLICIES {
        for file in [
            format!("policies/{robot}/base.yaml"),
            format!("policies/{robot}/{name}/config.yaml"),
            format!("{robot}-{name}.json"),
        ] {
            let here = fs::read_to_string(vectors().join(&file)).expect("a file");
            let made = fs::read_to_string(folder.join(&file)).expect("a file");
            let same = if file.ends_with(".json") {
                let [here, made] = [here, made].map(|it| serde_json::from_str(&it).expect("JSON"));
                is_near(&here, &made)
            } else {
                here == made
            };
            assert!(same, "{file} is not what make.py writes");
        }
    }
}
