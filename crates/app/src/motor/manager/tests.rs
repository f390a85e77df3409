use super::*;
use crate::{
    domain::{JointCommand, JointMode, StandardId},
    motor::layout::{ROBOT_LAYOUT, RS00_LAYOUT},
};

fn frame(id: u16, payload: [u8; 8]) -> CanFrame {
    CanFrame::new(StandardId::new(id).unwrap(), payload)
}

fn wheel_frame(id: u16, rpm: i16) -> CanFrame {
    let [high, low] = rpm.to_be_bytes();
    frame(id, [0, 0, high, low, 0, 0, 30, 0])
}

fn feedback(manager: &mut MotorManager, now_us: u64) -> MotorFeedback {
    let mut feedback = MotorFeedback::default();
    manager.feedback(&RobotConfig::default(), now_us, &mut feedback);
    feedback
}

#[test]
fn wheel_feedback_reaches_its_wheel_only_from_its_bus() {
    let mut manager = MotorManager::new(&ROBOT_LAYOUT);
    assert!(manager.route_frame(BusId::Can1, &wheel_frame(0x201, 100), 1_000));
    assert!(manager.route_frame(BusId::Can1, &wheel_frame(0x202, -100), 2_000));
    assert!(!manager.route_frame(BusId::Can2, &wheel_frame(0x201, 7), 3_000));
    assert!(!manager.route_frame(BusId::Can1, &wheel_frame(0x203, 7), 3_000));
    let [left, right] = feedback(&mut manager, 5_000).wheels;
    assert_eq!((left.rpm, left.age_us), (100, 4_000));
    assert_eq!((right.rpm, right.age_us), (-100, 3_000));
}

#[test]
fn joint_replies_reach_their_joint_only_from_their_bus() {
    for (layout, id) in [(&ROBOT_LAYOUT, 0x13), (&RS00_LAYOUT, 0xF3)] {
        let mut manager = MotorManager::new(layout);
        let reply = frame(id, [3, 0x7F, 0xFF, 0x7F, 0xF7, 0xFF, 0, 30]);
        assert!(!manager.route_frame(BusId::Can1, &reply, 1_000));
        assert!(manager.route_frame(BusId::Can2, &reply, 2_000));
        let ages = feedback(&mut manager, 5_000)
            .joints
            .map(|joint| joint.age_us);
        assert_eq!(ages, [u32::MAX, u32::MAX, 3_000, u32::MAX]);
    }
}

#[test]
fn a_silent_motor_never_looks_fresh() {
    let feedback = feedback(&mut MotorManager::new(&ROBOT_LAYOUT), 5);
    assert!(feedback.wheels.iter().all(|wheel| wheel.age_us == u32::MAX));
    assert!(feedback.joints.iter().all(|joint| joint.age_us == u32::MAX));
}

/// The wheels get zero current, joints 1 and 2 a disable frame in one tick, joints 3 and 4 in the next.
#[test]
fn without_a_permit_no_motor_has_torque() {
    let command = ChassisCommand {
        wheels: [WheelCommand {
            current_ma: 5_000.0,
        }; 2],
        joints: [JointCommand {
            mode: JointMode::Mit,
            tau_nm: 2.0,
            ..JointCommand::default()
        }; 4],
    };
    for layout in [&ROBOT_LAYOUT, &RS00_LAYOUT] {
        let mut manager = MotorManager::new(layout);
        let mut ids = Vec::<u16, 6>::new();
        for now_us in [1_000, 2_000] {
            let mut frames = TickFrames::new();
            let config = RobotConfig::default();
            manager.compose(&command, None, &config, false, now_us, &mut frames);
            let mut sent = command;
            manager.record_sent(&mut sent);
            assert_eq!(sent, ChassisCommand::default());
            for (bus, frame) in &frames {
                let zero = match bus {
                    BusId::Can1 => [0; 8],
                    BusId::Can2 => [0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFD],
                };
                assert_eq!(frame.payload(), zero);
                ids.push(frame.id().raw()).unwrap();
            }
        }
        assert_eq!(ids[..], [0x200, 1, 2, 0x200, 3, 4]);
    }
}
