//! Accelerations of any state under any torques, statics and energy.

use robot_description::Robot;
use robot_plant::free::{FreeBody, FreeInputs, FreeSetup, FreeState, Hold, Push, Start};
use robot_test_support::{Random, Rotation};
use serde_json::{Value, json};

use crate::oracle::{Oracle, inputs_json, numbers, robot, state_json};

const CASES: usize = 200;
/// Largest difference of an acceleration, as a share of the largest one of its state.
const ACCELERATION_SHARE: f64 = 1e-8;
/// The same for wheels that roll ideally.
const ROLLING_SHARE: f64 = 1e-6;
const ENERGY_SHARE: f64 = 1e-11;
const HOLDING_NM: f64 = 1e-9;

/// Well above the ground.
const HEIGHT_M: f64 = 5.0;
/// Short enough for the speeds to change evenly.
const STEP_S: f64 = 2e-6;

fn body(robot: &Robot, hold: Hold) -> FreeBody {
    let start = Start::Dropped { height_m: HEIGHT_M };
    let setup = FreeSetup {
        start,
        hold,
        ..FreeSetup::default()
    };
    FreeBody::new(robot, &setup)
}

/// A clamped body is level and at rest.
fn held(state: &FreeState, hold: Hold) -> FreeState {
    match hold {
        Hold::Free => *state,
        Hold::Clamped => FreeState {
            attitude: [1.0, 0.0, 0.0, 0.0],
            ..*state
        },
    }
}

/// Any state within the range of the joints in which a leg can close, as fast as a robot may fall, turn and kick.
fn any_state(random: &mut Random, robot: &Robot) -> FreeState {
    let ranges = [&robot.joints.range_rad.front, &robot.joints.range_rad.rear];
    let joint_rad = std::array::from_fn(|joint| {
        let [low, high] = *ranges[joint % 2];
        random.between(low.max(-0.9), high.min(0.9))
    });
    FreeState {
        position_m: [random.normal(), random.normal(), HEIGHT_M],
        attitude: Rotation::by(random.vector(2.0)).to_wxyz(),
        velocity_mps: random.vector(2.0),
        rate_rps: random.vector(4.0),
        joint_rad,
        joint_rps: std::array::from_fn(|_| 8.0 * random.normal()),
        wheel_rad: std::array::from_fn(|_| random.between(-3.0, 3.0)),
        wheel_rps: std::array::from_fn(|_| 20.0 * random.normal()),
    }
}

fn any_inputs(random: &mut Random) -> FreeInputs {
    FreeInputs {
        joint_nm: std::array::from_fn(|_| 4.0 * random.normal()),
        wheel_nm: std::array::from_fn(|_| 2.0 * random.normal()),
        push: Some(Push {
            force_n: random.vector(20.0),
            at_m: random.vector(0.1),
        }),
        ..FreeInputs::default()
    }
}

/// Change of speed over a step, per second: velocity in the world, rate in the body, hips, wheels.
fn mean_accelerations(
    body: &mut FreeBody,
    state: &FreeState,
    inputs: &FreeInputs,
    step_s: f64,
) -> Vec<f64> {
    body.set_state(state);
    let before = body.state();
    body.step(inputs, step_s);
    let after = body.state();
    let speeds = |it: &FreeState| {
        [
            &it.velocity_mps[..],
            &it.rate_rps,
            &it.joint_rps,
            &it.wheel_rps,
        ]
        .concat()
    };
    let pairs = speeds(&after).into_iter().zip(speeds(&before));
    pairs
        .map(|(after, before)| (after - before) / step_s)
        .collect()
}

/// Accelerations at the very start of a step: two step sizes tell them from their change.
fn accelerations(body: &mut FreeBody, state: &FreeState, inputs: &FreeInputs) -> Vec<f64> {
    let long = mean_accelerations(body, state, inputs, STEP_S);
    let short = mean_accelerations(body, state, inputs, STEP_S / 2.0);
    short.iter().zip(long).map(|(s, l)| 2.0 * s - l).collect()
}

fn assert_same_accelerations(name: &str, hold: Hold) {
    let robot = robot(name);
    let Some(oracle) = Oracle::new(&robot, &format!("accelerations-{hold:?}")) else {
        return;
    };
    let mut random = Random::new(1);
    let cases: Vec<_> = (0..CASES)
        .map(|_| {
            let state = held(&any_state(&mut random, &robot), hold);
            (state, any_inputs(&mut random))
        })
        .collect();
    let mut body = body(&robot, hold);
    let question = json!({
        "states": cases.iter().map(|(state, _)| state_json(state)).collect::<Vec<_>>(),
        "inputs": cases.iter().map(|(_, inputs)| inputs_json(inputs)).collect::<Vec<_>>(),
    });
    let answer = oracle.ask(hold, "accelerations", question);
    let mut worst = 0.0_f64;
    for ((state, inputs), expected) in cases.iter().zip(answer.as_array().expect("a list")) {
        let expected = numbers(expected);
        let all = accelerations(&mut body, state, inputs);
        let found = &all[all.len() - expected.len()..];
        let largest = expected.iter().fold(0.0_f64, |it, a| it.max(a.abs()));
        for (found, expected) in found.iter().zip(&expected) {
            worst = worst.max((found - expected).abs() / largest);
        }
        assert!(
            worst < ACCELERATION_SHARE,
            "{name}: {found:?} instead of {expected:?} at {state:?} under {inputs:?}"
        );
    }
    println!("{name} {hold:?}: accelerations differ by {worst:.1e} at most");
}

#[test]
fn a_free_robot_accelerates_as_in_mujoco() {
    assert_same_accelerations("fivebar", Hold::Free);
    assert_same_accelerations("fivebar-rs00", Hold::Free);
}

#[test]
fn legs_of_a_clamped_robot_accelerate_as_in_mujoco() {
    assert_same_accelerations("fivebar", Hold::Clamped);
}

/// What linear models of the robot are made of. Both legs stand alike: with one axle ahead of the other, wheels that never
/// slip sideways forbid to turn, and the plant gives way there by a hair.
#[test]
fn ideal_wheels_roll_as_in_mujoco() {
    let robot = robot("fivebar");
    let Some(oracle) = Oracle::new(&robot, "rolling-ideally") else {
        return;
    };
    let mut random = Random::new(3);
    let cases: Vec<_> = (0..CASES)
        .map(|_| {
            let state = any_state(&mut random, &robot);
            let [front_rad, rear_rad, ..] = state.joint_rad;
            let state = FreeState {
                attitude: Rotation::by(random.vector(0.2)).to_wxyz(),
                joint_rad: [front_rad, rear_rad, front_rad, rear_rad],
                velocity_mps: [0.0; 3],
                rate_rps: [0.0; 3],
                joint_rps: [0.0; 4],
                wheel_rps: [0.0; 2],
                ..state
            };
            (state, any_inputs(&mut random))
        })
        .collect();
    let radius_m = robot.wheels.radius_m;
    let question = json!({
        "states": cases.iter().map(|(state, _)| state_json(state)).collect::<Vec<_>>(),
        "inputs": cases.iter().map(|(_, inputs)| inputs_json(inputs)).collect::<Vec<_>>(),
        "radius_m": radius_m,
        // The tyre's cross-section is round.
        "tyre_m": (robot.wheels.width_m / 2.0).min(radius_m / 2.0),
    });
    let answer = oracle.ask(Hold::Free, "rolling", question);
    let mut body = body(&robot, Hold::Free);
    let mut worst = 0.0_f64;
    for ((state, inputs), expected) in cases.iter().zip(answer.as_array().expect("a list")) {
        body.set_state(state);
        let all = body.rolling_accelerations(inputs);
        let found = [
            &all.linear_mps2[..],
            &all.angular_rps2,
            &all.joint_rps2,
            &all.wheel_rps2,
        ]
        .concat();
        let expected = numbers(expected);
        let largest = expected.iter().fold(0.0_f64, |it, a| it.max(a.abs()));
        for (found, expected) in found.iter().zip(&expected) {
            worst = worst.max((found - expected).abs() / largest);
        }
        assert!(
            worst < ROLLING_SHARE,
            "{found:?} instead of {expected:?} at {state:?} under {inputs:?}"
        );
    }
    println!("rolling ideally: accelerations differ by {worst:.1e} at most");
}

#[test]
fn energy_is_that_of_mujoco() {
    let robot = robot("fivebar");
    let Some(oracle) = Oracle::new(&robot, "energy") else {
        return;
    };
    let mut random = Random::new(2);
    let states: Vec<_> = (0..CASES).map(|_| any_state(&mut random, &robot)).collect();
    let question = json!({ "states": states.iter().map(state_json).collect::<Vec<_>>() });
    let expected = numbers(&oracle.ask(Hold::Free, "energies", question));
    let mut body = body(&robot, Hold::Free);
    for (state, expected) in states.iter().zip(expected) {
        body.set_state(state);
        let found = body.energy_j();
        let share = (found - expected).abs() / expected.abs();
        assert!(share < ENERGY_SHARE, "{found} J instead of {expected} J");
    }
}

/// Hip angles over the range in which the robot stands.
fn standing_grid() -> Vec<[f64; 4]> {
    let steps = (-5..=3).map(|n| 0.2 * f64::from(n));
    let pairs = steps
        .clone()
        .flat_map(|a| steps.clone().map(move |b| (a, b)));
    pairs.map(|(a, b)| [a, -b, b, -a]).collect()
}

#[test]
fn legs_are_held_by_the_torques_of_mujoco() {
    let robot = robot("fivebar");
    let Some(oracle) = Oracle::new(&robot, "holding") else {
        return;
    };
    let mut body = body(&robot, Hold::Clamped);
    let rest = FreeState {
        joint_rps: [0.0; 4],
        wheel_rps: [0.0; 2],
        ..body.state()
    };
    let poses: Vec<_> = standing_grid()
        .into_iter()
        .map(|joint_rad| FreeState { joint_rad, ..rest })
        .collect();
    let forces = [[3.0, 31.0], [-8.0, 45.0]];
    let question = json!({
        "states": poses.iter().map(state_json).collect::<Vec<_>>(),
        "axle_force_n": vec![forces; poses.len()],
    });
    let answer = oracle.ask(Hold::Clamped, "holding", question);
    for (pose, expected) in poses.iter().zip(answer.as_array().expect("a list")) {
        body.set_state(pose);
        let found = body.holding_torque_nm(forces);
        let near = |expected: &Value| {
            let pairs = numbers(expected).into_iter().zip(found);
            pairs.fold(0.0_f64, |it, (a, b)| it.max((a - b).abs())) < HOLDING_NM
        };
        assert!(
            near(expected),
            "{found:?} instead of {expected} at {:?}",
            pose.joint_rad
        );
    }
}
