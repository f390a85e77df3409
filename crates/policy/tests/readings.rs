//! Readings and outputs from which nothing can be made are refused by name, and change nothing.

use std::path::Path;

use robot_policy::{
    PolicyDescription,
    action::{ActionError, Decoder, Target},
    config,
    observation::{Commands, ObserveError, Observer, Reading},
};

fn policy(robot: &str, name: &str) -> PolicyDescription {
    let policies = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/vectors/policies");
    config::read(&policies, robot, name).expect("a policy")
}

fn refused(policy: &PolicyDescription, reading: &Reading, last_actions: &[f32]) -> ObserveError {
    let mut observer = Observer::new(policy);
    let observed = observer.observe(reading, &Commands::default(), last_actions);
    observed.expect_err("it is refused")
}

#[test]
fn readings_of_another_robot_are_refused() {
    let policy = policy("fivebar", "flat");
    let whole = Reading::at_default_pose(&policy);
    let mut short = whole.clone();
    short.joint_vel_rps.pop();
    let said = refused(&policy, &short, &[0.0; 6]).to_string();
    assert_eq!(said, "joint speeds: 5 values for the policy's 6 joints");
    let said = refused(&policy, &whole, &[0.0; 4]).to_string();
    assert_eq!(said, "last actions: 4 values for the policy's 6 joints");
}

#[test]
fn a_value_that_is_no_number_is_named_even_where_it_would_be_clipped() {
    let policy = policy("fivebar", "flat");
    for value in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let mut reading = Reading::at_default_pose(&policy);
        reading.joint_vel_rps[4] = value;
        let said = refused(&policy, &reading, &[0.0; 6]).to_string();
        assert_eq!(said, format!("wheel_joint_vel[0] is {value}"));
    }
}

#[test]
fn a_velocity_that_nobody_measures_is_named() {
    let policy = policy("legs", "velocity");
    assert!(policy.needs_linear_velocity());
    let reading = Reading::at_default_pose(&policy);
    let error = refused(&policy, &reading, &[0.0; 12]);
    assert_eq!(
        error,
        ObserveError::NoLinearVelocity {
            term: "lin_vel".to_owned()
        }
    );
}

/// Inputs for wheel speeds 1, 2, 3 …, of which those of `bad` are refused.
fn inputs(policy: &PolicyDescription, bad: &[usize]) -> Vec<Vec<f32>> {
    let mut observer = Observer::new(policy);
    let mut reading = Reading::at_default_pose(policy);
    let mut inputs = Vec::new();
    for step in 0..8 {
        if bad.contains(&step) {
            let mut broken = reading.clone();
            // Behind the wheels in a frame: what comes before it is already there when it is found.
            broken.body_rates_rps[2] = f32::NAN;
            broken.joint_vel_rps[4] = 99.0;
            let refused = observer.observe(&broken, &Commands::default(), &[0.0; 6]);
            assert!(refused.is_err());
        }
        reading.joint_vel_rps[4] = step as f32;
        let input = observer.observe(&reading, &Commands::default(), &[0.0; 6]);
        inputs.push(input.expect("an input").to_vec());
    }
    inputs
}

#[test]
fn a_refused_reading_leaves_no_trace_in_the_history() {
    for name in ["flat", "flat-by-term"] {
        let policy = policy("fivebar", name);
        assert_eq!(inputs(&policy, &[0, 3, 4, 7]), inputs(&policy, &[]));
    }
}

#[test]
fn commands_keep_within_their_ranges() {
    let mut policy = policy("two-wheels", "plain");
    policy.command_ranges = [[-0.5, 1.0], [0.0, 0.0], [-2.0, 2.0]];
    let mut observer = Observer::new(&policy);
    let commands = Commands {
        forward_mps: 3.0,
        left_mps: 1.0,
        yaw_rps: -9.0,
    };
    let reading = Reading::at_default_pose(&policy);
    let input = observer.observe(&reading, &commands, &[0.0; 8]);
    // Behind rates and gravity, scaled by 2, 2, 0.25.
    assert_eq!(input.expect("an input")[6..9], [2.0, 0.0, -0.5]);
    for forward_mps in [f32::INFINITY, f32::NAN] {
        let commands = Commands {
            forward_mps,
            ..commands
        };
        let error = observer
            .observe(&reading, &commands, &[0.0; 8])
            .unwrap_err();
        assert_eq!(error.to_string(), format!("commands[0] is {forward_mps}"));
    }
}

#[test]
fn outputs_that_cannot_be_obeyed_change_nothing() {
    let policy = policy("fivebar", "flat");
    let mut decoder = Decoder::new(&policy);
    decoder.decode(&[0.5; 6]).expect("targets");
    let error = decoder.decode(&[0.1; 5]).unwrap_err();
    assert_eq!(
        error,
        ActionError::Count {
            wanted: 6,
            found: 5
        }
    );
    let mut output = [0.1; 6];
    output[5] = f32::NAN;
    let said = decoder.decode(&output).unwrap_err().to_string();
    assert_eq!(said, "the network's action for right_wheel is NaN");
    assert_eq!(decoder.last_actions(), [0.5; 6]);
    decoder.reset();
    assert_eq!(decoder.last_actions(), [0.0; 6]);
}

#[test]
fn a_limit_moves_a_target_only_as_far_as_needed() {
    let position = |rad, kp| Target::Position { rad, kp, kd: 0.5 };
    // 20 · (1.0 − 0.2) − 0.5 · 2 = 15 N·m, of which 5 are left.
    let limited = position(1.0, 20.0).within_torque(5.0, 0.2, 2.0);
    assert!(
        (limited.torque_nm(0.2, 2.0) - 5.0).abs() < 1e-5,
        "{limited:?}"
    );
    let free = position(0.3, 20.0);
    assert_eq!(free.within_torque(5.0, 0.2, 2.0), free);
    let limp = position(1.0, 0.0);
    assert_eq!(limp.within_torque(5.0, 0.2, 2.0), limp);
    let wheel = Target::Speed { rps: 40.0, kd: 0.5 };
    let limited = wheel.within_torque(2.0, 0.0, 10.0);
    assert_eq!(limited, Target::Speed { rps: 14.0, kd: 0.5 });
}
