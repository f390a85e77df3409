//! The parameter store requests writes while motors are present.

use robot_app::{
    domain::{FlashRequest, JointState},
    safety::{ArmingBlockers, FlashGrant},
};
use robot_plant::robots::JointMotor;

use crate::robot::Robot;

const BOTH: [JointMotor; 2] = [JointMotor::Dm4310, JointMotor::Rs00];

#[test]
fn arming_waits_until_the_record_is_written() {
    for kind in BOTH {
        let mut robot = Robot::new(kind);
        robot.run(1.5);
        robot.flash_request = FlashRequest::Program;
        robot.run(0.001);
        assert_eq!(robot.flash().granted, FlashRequest::Program);
        robot.enabled = true;
        robot.run_watching(0.1, |robot| {
            assert_eq!(robot.states(), [JointState::Disabled; 4]);
        });
        let blockers = robot.diagnostics().arming.blockers;
        assert_eq!(blockers, ArmingBlockers::FLASH_BUSY);
        robot.flash_request = FlashRequest::None;
        robot.run(0.002);
        assert!(robot.is_armed());
    }
}

#[test]
fn nothing_is_granted_from_enabling_until_half_a_second_after_disarming() {
    for kind in BOTH {
        for request in [FlashRequest::Program, FlashRequest::Erase] {
            let mut robot = Robot::armed(kind);
            robot.flash_request = request;
            let refused = |robot: &Robot| assert_eq!(robot.flash(), FlashGrant::default());
            robot.run_watching(0.3, refused);
            robot.enabled = false;
            robot.run_watching(0.5, refused);
            robot.run(0.01);
            assert!(robot.flash().blocks_arming);
        }
    }
}
