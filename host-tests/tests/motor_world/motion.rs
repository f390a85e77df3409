//! Every control mode moves the leg as commanded, on both sides of the robot.

use robot_app::domain::{JointCommand, JointMode, JointState};
use robot_plant::robots::JointMotor;

use crate::robot::Robot;

const BOTH: [JointMotor; 2] = [JointMotor::Dm4310, JointMotor::Rs00];
const POSITIONS: &str = "truth.joint.{}.pos_rad";

/// Gravity pulls 1 N·m at most, so a spring of 50 N·m/rad is off by at most 0.02 rad.
#[test]
fn mit_holds_a_pose() {
    for kind in BOTH {
        let mut robot = Robot::armed(kind);
        for (joint, pos_rad) in [0.4, -0.4, 0.4, -0.4].into_iter().enumerate() {
            robot.command.joints[joint] = JointCommand {
                mode: JointMode::Mit,
                pos_rad,
                kp: 50.0,
                kd: 2.0,
                ..JointCommand::default()
            };
        }
        robot.run(2.0);
        let truth = robot.joint_signals(POSITIONS);
        for (joint, wanted) in [0.4, -0.4, 0.4, -0.4].into_iter().enumerate() {
            assert!((truth[joint] - wanted).abs() < 0.03, "{kind:?} {truth:?}");
            let reported = f64::from(robot.joint(joint).pos_rad);
            assert!((reported - truth[joint]).abs() < 1e-3, "{reported}");
        }
    }
}

#[test]
fn torque_and_speed_have_the_sign_of_the_joint() {
    for kind in BOTH {
        let mut robot = Robot::armed(kind);
        robot.command_joints(JointCommand {
            mode: JointMode::Mit,
            tau_nm: 0.5,
            ..JointCommand::default()
        });
        robot.run(0.03);
        for joint in 0..4 {
            let truth = robot.signal(&format!("truth.joint.{joint}.vel_rps"));
            assert!(truth > 0.1, "{kind:?} {joint}: {truth}");
            assert!((f64::from(robot.joint(joint).vel_rps) - truth).abs() < 0.1);
            assert!((robot.joint(joint).torque_nm - 0.5).abs() < 0.2);
        }
    }
}

#[test]
fn position_mode_respects_the_commanded_speed_limit() {
    for kind in BOTH {
        let mut robot = Robot::armed(kind);
        robot.command_joints(JointCommand {
            mode: JointMode::PositionSpeed,
            pos_rad: 0.6,
            vel_rps: 1.0,
            ..JointCommand::default()
        });
        let mut fastest = 0.0_f64;
        robot.run_watching(2.5, |robot| {
            for vel_rps in robot.joint_signals("truth.joint.{}.vel_rps") {
                fastest = fastest.max(vel_rps.abs());
            }
        });
        assert_eq!(robot.states(), [JointState::Enabled; 4]);
        let truth = robot.joint_signals(POSITIONS);
        assert!(
            truth.iter().all(|pos| (pos - 0.6).abs() < 0.05),
            "{kind:?} {truth:?}"
        );
        assert!(fastest < 1.5, "{kind:?} {fastest}");
    }
}

#[test]
fn speed_mode_turns_at_the_commanded_speed() {
    for kind in BOTH {
        let mut robot = Robot::armed(kind);
        robot.command_joints(JointCommand {
            mode: JointMode::Speed,
            vel_rps: 0.3,
            ..JointCommand::default()
        });
        // Up to half a second goes by while the motor changes its mode.
        robot.run(1.5);
        let before = robot.joint_signals(POSITIONS);
        robot.run(0.5);
        let after = robot.joint_signals(POSITIONS);
        for (before, after) in before.iter().zip(after) {
            assert!(
                (after - before - 0.15).abs() < 0.05,
                "{kind:?} {before} {after}"
            );
        }
    }
}

/// `Off` needs an MIT frame, which a motor in speed mode would not understand, so the motor is disabled.
#[test]
fn off_in_another_mode_is_disabled() {
    for kind in BOTH {
        let mut robot = Robot::armed(kind);
        robot.command_joints(JointCommand {
            mode: JointMode::Speed,
            vel_rps: 0.2,
            ..JointCommand::default()
        });
        robot.run(1.0);
        assert_eq!(robot.states(), [JointState::Enabled; 4]);
        robot.command_joints(JointCommand::default());
        robot.run(0.003);
        assert_eq!(robot.joint_signals("can.joint.{}.enabled"), [0.0; 4]);
        assert_eq!(robot.states(), [JointState::Disabled; 4]);
    }
}
