//! Motors that vanish, report faults, freeze or have another identifier.

use robot_app::domain::{JointCommand, JointMode, JointState};
use robot_plant::robots::JointMotor;

use crate::robot::Robot;

const BOTH: [JointMotor; 2] = [JointMotor::Dm4310, JointMotor::Rs00];

const HOLD: JointCommand = JointCommand {
    mode: JointMode::Mit,
    pos_rad: 0.3,
    vel_rps: 0.0,
    kp: 30.0,
    kd: 1.0,
    tau_nm: 0.0,
};

/// Joint 0 is motor 2 of the fault names.
fn armed_holding(kind: JointMotor) -> Robot {
    let mut robot = Robot::armed(kind);
    robot.command_joints(HOLD);
    robot.run(0.5);
    robot
}

/// Makes the clearing gesture for long enough.
fn clear(robot: &mut Robot) {
    robot.enabled = false;
    robot.e_stop = true;
    robot.run(1.5);
    robot.e_stop = false;
    robot.run(0.5);
}

#[test]
fn a_motor_that_lost_its_supply_is_silent_and_set_up_again() {
    for kind in BOTH {
        let mut robot = armed_holding(kind);
        robot.fault("motor-2-gone", true);
        robot.run(0.07);
        assert_eq!(robot.joint(0).state, JointState::Silent);
        robot.fault("motor-2-gone", false);
        let mut states = Vec::new();
        robot.run_watching(1.0, |robot| {
            let state = robot.joint(0).state;
            if states.last() != Some(&state) {
                states.push(state);
            }
        });
        assert_eq!(
            states[..2],
            [JointState::Silent, JointState::SettingUp],
            "{kind:?}"
        );
        assert!(
            matches!(
                states.last(),
                Some(JointState::Enabled | JointState::Disabled)
            ),
            "{kind:?} {states:?}"
        );
    }
}

#[test]
fn a_fault_is_named_and_stays_until_the_pilot_clears_it() {
    for kind in BOTH {
        let mut robot = armed_holding(kind);
        robot.fault("motor-2-fault", true);
        robot.run(0.5);
        let code = robot.joint(0).fault_code;
        assert_eq!(robot.joint(0).state, JointState::Fault, "{kind:?}");
        match kind {
            // Over-current.
            JointMotor::Dm4310 => assert_eq!(code, 0xA),
            JointMotor::Rs00 => assert_ne!(code, 0),
        }
        robot.fault("motor-2-fault", false);
        robot.run(0.5);
        assert_eq!(robot.joint(0).state, JointState::Fault);
        clear(&mut robot);
        assert_eq!(robot.states(), [JointState::Disabled; 4], "{kind:?}");
        assert_eq!(robot.joint(0).fault_code, 0);
        robot.enabled = true;
        robot.run(0.1);
        assert_eq!(robot.states(), [JointState::Enabled; 4], "{kind:?}");
    }
}

#[test]
fn a_persisting_fault_returns_at_once() {
    for kind in BOTH {
        let mut robot = armed_holding(kind);
        robot.fault("motor-2-fault", true);
        robot.run(0.2);
        clear(&mut robot);
        robot.run(0.3);
        assert_eq!(robot.joint(0).state, JointState::Fault, "{kind:?}");
        assert_eq!(robot.joint_signals("can.joint.{}.enabled")[0], 0.0);
    }
}

/// The interruption is too short to count as silence, but it resets a DM4310's time-out to the factory setting: none.
#[test]
fn a_motor_whose_supply_fails_briefly_is_set_up_again() {
    let mut robot = armed_holding(JointMotor::Dm4310);
    robot.fault("motor-2-gone", true);
    robot.run(0.03);
    robot.fault("motor-2-gone", false);
    robot.run(1.0);
    assert_eq!(robot.joint_signals("can.joint.{}.enabled"), [1.0; 4]);
    robot.run_without_board(110, |_, _| {});
    assert_eq!(robot.joint_signals("can.joint.{}.enabled"), [0.0; 4]);
}

const DISABLE: [u8; 8] = [0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFD];
const ENABLE: [u8; 8] = [0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFC];

/// A motor that something else disabled is enabled again, a few times a second at most.
#[test]
fn a_motor_disabled_by_another_sender_is_enabled_again() {
    let mut robot = armed_holding(JointMotor::Dm4310);
    robot.receive_unknown_frame(1, DISABLE);
    assert_eq!(robot.joint_signals("can.joint.{}.enabled")[0], 0.0);
    robot.run(0.3);
    assert_eq!(robot.states(), [JointState::Enabled; 4]);
    assert_eq!(robot.joint_signals("can.joint.{}.enabled"), [1.0; 4]);
    let mut enable_frames = 0;
    for ms in 0..1_000 {
        // Between two of them there is time to set the motor up anew.
        if ms % 50 == 0 {
            robot.receive_unknown_frame(1, DISABLE);
        }
        robot.run(1e-3);
        enable_frames += robot
            .sent()
            .iter()
            .filter(|(_, frame)| frame.id().raw() == 1 && frame.payload() == ENABLE)
            .count();
    }
    // Once every 250 ms, for five slots in 10 ms at most.
    assert!((4..=25).contains(&enable_frames), "{enable_frames}");
}

#[test]
fn a_motor_with_another_identifier_is_silent() {
    for kind in BOTH {
        let mut robot = armed_holding(kind);
        robot.fault("motor-2-wrong-id", true);
        robot.run(0.1);
        let states = robot.states();
        assert_eq!(states[0], JointState::Silent, "{kind:?}");
        assert!(states[1..].iter().all(|state| *state != JointState::Silent));
    }
}

#[test]
fn a_joint_that_repeats_its_last_reply_in_motion_is_frozen() {
    for kind in BOTH {
        let mut robot = armed_holding(kind);
        robot.command_joints(JointCommand {
            pos_rad: -0.8,
            ..HOLD
        });
        robot.run(0.06);
        assert!(robot.joint(0).vel_rps.abs() > 0.5, "{kind:?}");
        robot.fault("motor-2-frozen", true);
        robot.run(0.045);
        assert!(!robot.joint(0).frozen);
        robot.run(0.015);
        assert!(robot.joint(0).frozen, "{kind:?}");
        assert!((1..4).all(|joint| !robot.joint(joint).frozen));
    }
}

/// Its reported torque no longer fits the command.
#[test]
fn a_joint_that_repeats_its_last_reply_at_rest_is_frozen_once_commanded() {
    for kind in BOTH {
        let mut robot = armed_holding(kind);
        robot.run(1.0);
        robot.fault("motor-2-frozen", true);
        robot.run(0.3);
        assert!(!robot.joint(0).frozen);
        robot.command_joints(JointCommand {
            pos_rad: -0.8,
            ..HOLD
        });
        robot.run(0.09);
        assert!(!robot.joint(0).frozen);
        robot.run(0.03);
        assert!(robot.joint(0).frozen, "{kind:?}");
    }
}

#[test]
fn a_wheel_that_repeats_its_last_feedback_is_frozen() {
    let mut robot = Robot::armed(JointMotor::Dm4310);
    robot.command.wheels[0].current_ma = 1_500.0;
    robot.run(0.5);
    assert!(robot.diagnostics().sensors.motor.wheels[0].rpm > 60);
    robot.fault("motor-0-frozen", true);
    robot.run(0.045);
    assert!(!robot.diagnostics().sensors.motor.wheels[0].frozen);
    robot.run(0.015);
    let [left, right] = robot.diagnostics().sensors.motor.wheels;
    assert!(left.frozen && !right.frozen);
}

#[test]
fn a_wheel_that_repeats_its_last_feedback_at_rest_is_frozen_once_commanded() {
    let mut robot = Robot::armed(JointMotor::Dm4310);
    robot.fault("motor-0-frozen", true);
    robot.run(0.3);
    assert!(!robot.diagnostics().sensors.motor.wheels[0].frozen);
    robot.command.wheels[0].current_ma = 2_000.0;
    robot.run(0.095);
    assert!(!robot.diagnostics().sensors.motor.wheels[0].frozen);
    robot.run(0.01);
    assert!(robot.diagnostics().sensors.motor.wheels[0].frozen);
}

#[test]
fn a_stalled_wheel_is_not_frozen() {
    let mut robot = Robot::armed(JointMotor::Dm4310);
    robot.command.wheels[0].current_ma = 900.0;
    robot.run_watching(1.0, |robot| {
        assert!(!robot.diagnostics().sensors.motor.wheels[0].frozen);
    });
}
