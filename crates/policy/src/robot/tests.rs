#![cfg(feature = "link")]

use robot_app::link::MotorState;

use super::*;
use crate::{JointMapping, runner::testing};

/// What a message says, and the damage that it is about.
type Damage = (&'static str, fn(&mut Uplink));

fn state() -> Uplink {
    let motors = std::array::from_fn(|motor| MotorState {
        pos_rad: 0.1 * motor as f32,
        vel_rps: -0.01 * motor as f32,
    });
    Uplink {
        // 90° about x.
        q_xyzw: [0.6, 0.0, 0.0, 0.8],
        gyro_rps: [1.0, 2.0, 3.0],
        motors,
        ..Uplink::default()
    }
}

#[test]
fn a_state_is_read_in_the_policys_order_and_sense() {
    let mut policy = testing::policy();
    policy.mapping = JointMapping::new(vec![2, 3, 4, 5, 0, 1], &[1, -1, 1, 1, 1, -1]).unwrap();
    let mut robot = LinkRobot::new(&policy).expect("its robot");
    robot.read(&state()).expect("a state");
    let reading = robot.reading();
    let near =
        |found: &[f32], wanted: &[f32]| found.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-6);
    assert!(
        near(&reading.joint_pos_rad, &[0.2, -0.3, 0.4, 0.5, 0.0, -0.1]),
        "{reading:?}"
    );
    assert!(
        near(
            &reading.joint_vel_rps,
            &[-0.02, 0.03, -0.04, -0.05, 0.0, 0.01]
        ),
        "{reading:?}"
    );
    assert_eq!(reading.attitude.wxyz(), [0.8, 0.6, 0.0, 0.0]);
    assert_eq!(reading.body_rates_rps, [1.0, 2.0, 3.0]);
}

#[test]
fn targets_go_to_their_motors_and_no_frame_repeats_the_last() {
    let mut policy = testing::policy();
    policy.mapping = JointMapping::new(vec![2, 3, 4, 5, 0, 1], &[1, -1, 1, 1, 1, -1]).unwrap();
    let mut robot = LinkRobot::new(&policy).expect("its robot");
    let joint = |rad| Target::Position {
        rad,
        kp: 20.0,
        kd: 0.8,
    };
    let wheel = |rps| Target::Speed { rps, kd: 0.3 };
    let targets = [
        joint(0.1),
        joint(0.2),
        joint(0.3),
        joint(0.4),
        wheel(5.0),
        wheel(6.0),
    ];
    let command = robot.command(&targets);
    assert_eq!(command.joints.map(|it| it.pos_rad), [0.1, -0.2, 0.3, 0.4]);
    assert!(
        command
            .joints
            .iter()
            .all(|it| (it.kp, it.kd) == (20.0, 0.8))
    );
    assert_eq!(command.wheels.map(|it| it.speed_rps), [5.0, -6.0]);
    assert!(command.wheels.iter().all(|it| it.kd == 0.3));
    let mut before = command.encode();
    for _ in 0..600 {
        let next = robot.command(&targets).encode();
        assert_ne!(next, before);
        before = next;
    }
}

#[test]
fn a_limp_frame_has_no_gain() {
    let mut robot = LinkRobot::new(&testing::policy()).expect("its robot");
    let limp = robot.limp();
    assert!(limp.joints.iter().all(|it| it.kp == 0.0 && it.kd == 0.0));
    assert!(
        limp.wheels
            .iter()
            .all(|it| it.kd == 0.0 && it.speed_rps == 0.0)
    );
    assert_ne!(limp.encode(), robot.limp().encode());
}

#[test]
fn a_policy_of_another_robot_is_refused() {
    let mut policy = testing::policy();
    policy.mapping = JointMapping::new(vec![0, 1, 2, 3, 4, 5], &[1; 6]).unwrap();
    let error = LinkRobot::new(&policy).unwrap_err().to_string();
    assert!(
        error.contains("left_front_hip is motor 0 of the PC link, left_wheel, which is a wheel"),
        "{error}"
    );
    let mut policy = testing::policy();
    policy.joints.pop();
    assert_eq!(
        LinkRobot::new(&policy).unwrap_err(),
        OtherRobot::Joints { found: 5 }
    );
}

#[test]
fn a_value_that_cannot_be_is_named_and_changes_nothing() {
    let mut robot = LinkRobot::new(&testing::policy()).expect("its robot");
    robot.read(&state()).expect("a state");
    let before = robot.reading().clone();
    let wrong: [Damage; 5] = [
        ("attitude", |state| state.q_xyzw = [0.0; 4]),
        ("gyro y is NaN", |state| state.gyro_rps[1] = f32::NAN),
        ("gyro z is 60", |state| state.gyro_rps[2] = 60.0),
        ("angle of right_rear_hip", |state| {
            state.motors[5].pos_rad = std::f32::consts::PI
        }),
        ("speed of left_wheel is NaN", |state| {
            state.motors[0].vel_rps = f32::NAN
        }),
    ];
    for (said, damage) in wrong {
        let mut state = state();
        state.motors[2].pos_rad = -1.0;
        damage(&mut state);
        let error = robot.read(&state).unwrap_err().to_string();
        assert!(error.contains(said), "{error}");
        assert_eq!(robot.reading(), &before);
    }
}
