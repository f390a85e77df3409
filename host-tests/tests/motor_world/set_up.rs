//! From power-on to enabled motors.

use robot_app::domain::JointState;
use robot_plant::robots::JointMotor;

use crate::robot::Robot;

const BOTH: [JointMotor; 2] = [JointMotor::Dm4310, JointMotor::Rs00];

#[test]
fn motors_are_verified_before_they_count_as_ready() {
    let [dm4310, rs00] = BOTH;
    for (kind, slow) in [(dm4310, false), (dm4310, true), (rs00, false)] {
        let mut robot = Robot::new(kind);
        robot.fault("joint-writes-slow", slow);
        let mut seen = Vec::new();
        robot.run_watching(1.0, |robot| {
            let state = robot.joint(0).state;
            if seen.last() != Some(&state) {
                seen.push(state);
            }
        });
        let [first, .., last] = seen[..] else {
            panic!("{seen:?}");
        };
        assert_eq!((first, last), (JointState::Silent, JointState::Disabled));
        assert!(seen.contains(&JointState::SettingUp), "{seen:?}");
        assert_eq!(robot.states(), [JointState::Disabled; 4]);
        assert_eq!(robot.joint_signals("can.joint.{}.enabled"), [0.0; 4]);
    }
}

/// The longest erase of a sector (STM32F407 datasheet table 40).
const ERASE_MS: u32 = 500;

/// States of joint 0 in the tenth of a second after an erase.
fn states_after_stall(kind: JointMotor, told: bool) -> Vec<JointState> {
    let mut robot = Robot::new(kind);
    robot.run(1.5);
    robot.stall(ERASE_MS.into());
    if told {
        robot.report_stall(ERASE_MS);
    }
    let mut states = Vec::new();
    robot.run_watching(0.1, |robot| states.push(robot.joint(0).state));
    let latched: Vec<_> = robot.diagnostics().safety.latched.names().collect();
    assert!(latched.is_empty(), "{latched:?}");
    let tick = &robot.diagnostics().tick;
    assert_eq!(
        (tick.missed, tick.stalls),
        if told { (0, 1) } else { (500, 0) }
    );
    states
}

#[test]
fn joints_are_not_set_up_again_because_the_board_stood_still() {
    for kind in BOTH {
        assert_eq!(states_after_stall(kind, true), [JointState::Disabled; 100]);
        assert!(states_after_stall(kind, false).contains(&JointState::Silent));
    }
}

/// A motor from the factory has no time-out. The firmware sets one of 100 ms, after which the motor releases torque.
#[test]
fn an_abandoned_dm4310_releases_torque() {
    let mut robot = Robot::armed(JointMotor::Dm4310);
    assert_eq!(robot.joint_signals("can.joint.{}.enabled"), [1.0; 4]);
    let mut let_go_after_ms = 0;
    robot.run_without_board(200, |robot, ms| {
        if robot.joint_signals("can.joint.{}.enabled") == [1.0; 4] {
            let_go_after_ms = ms;
        }
    });
    assert!((95..=105).contains(&let_go_after_ms), "{let_go_after_ms}");
}

#[test]
fn motors_are_enabled_only_while_armed() {
    for kind in BOTH {
        let mut robot = Robot::armed(kind);
        assert_eq!(robot.joint_signals("can.joint.{}.enabled"), [1.0; 4]);
        robot.enabled = false;
        robot.run(0.01);
        assert_eq!(robot.joint_signals("can.joint.{}.enabled"), [0.0; 4]);
        assert_eq!(robot.states(), [JointState::Disabled; 4]);
        robot.run(0.3);
        robot.enabled = true;
        robot.run(0.05);
        assert_eq!(robot.joint_signals("can.joint.{}.enabled"), [1.0; 4]);
    }
}

/// The zero of an MIT frame is half a torque step: 10/4095 and 14/4095 N·m.
#[test]
fn off_is_the_torque_code_nearest_to_zero() {
    for (kind, half_step_nm) in [(JointMotor::Dm4310, 2.45e-3), (JointMotor::Rs00, 3.42e-3)] {
        let mut robot = Robot::armed(kind);
        robot.run_watching(0.1, |robot| {
            for torque_nm in robot.joint_signals("can.joint.{}.torque_nm") {
                assert!(torque_nm.abs() < half_step_nm, "{torque_nm}");
            }
        });
    }
}

#[test]
fn the_pilots_stop_reaches_every_joint_within_two_ticks() {
    for kind in BOTH {
        for offset_ms in 0..2 {
            let mut robot = Robot::armed(kind);
            robot.run(f64::from(offset_ms) * 1e-3);
            robot.e_stop = true;
            robot.run(2e-3);
            assert_eq!(robot.joint_signals("can.joint.{}.enabled"), [0.0; 4]);
            assert_eq!(robot.joint_signals("can.joint.{}.torque_nm"), [0.0; 4]);
        }
    }
}

#[test]
fn each_joint_gets_a_frame_in_every_second_tick() {
    let mut robot = Robot::new(JointMotor::Dm4310);
    let mut told = Vec::new();
    robot.run(0.5);
    robot.run_watching(4e-3, |robot| {
        let ids: Vec<u16> = robot
            .sent()
            .iter()
            .map(|(_, frame)| frame.id().raw())
            .collect();
        told.push(ids);
    });
    let left = vec![0x200, 1, 2];
    let right = vec![0x200, 3, 4];
    let expected = if told[0] == left {
        [left.clone(), right.clone(), left, right]
    } else {
        [right.clone(), left.clone(), right, left]
    };
    assert_eq!(told, expected);
}
