use super::*;
use crate::{domain::robots, motor::mit::MitRanges};

const RANGES: MitRanges = MitRanges {
    p_max_rad: 12.5,
    v_max_rps: 30.0,
    t_max_nm: 10.0,
};

fn dm4310(number: u8, master_id: u16) -> JointMotor {
    JointMotor::Dm4310(Dm4310::new(number, master_id, RANGES).unwrap())
}

fn rs00(number: u8, host: u8) -> JointMotor {
    JointMotor::Rs00(Rs00::new(number, host).unwrap())
}

/// The robot's layout with changed joints.
fn joints(change: impl FnOnce(&mut [JointSlot; 4])) -> MotorLayout {
    let mut joints = *ROBOT_LAYOUT.joints();
    change(&mut joints);
    MotorLayout::new(&robots::FIVEBAR, *ROBOT_LAYOUT.wheels(), joints)
}

#[test]
fn motor_makes_may_be_mixed() {
    let layout = joints(|joints| {
        joints[2].motor = rs00(3, 0xF3);
        joints[3].motor = rs00(4, 0xF4);
    });
    assert_eq!(layout.joints()[0], ROBOT_LAYOUT.joints()[0]);
}

#[test]
#[should_panic(expected = "two joints on one bus use the same identifier")]
fn two_motors_with_one_number() {
    joints(|joints| joints[1].motor = dm4310(1, 0x12));
}

#[test]
#[should_panic(expected = "two joints on one bus use the same identifier")]
fn two_dm4310_replying_alike() {
    joints(|joints| joints[1].motor = dm4310(2, 0x11));
}

#[test]
#[should_panic(expected = "two joints on one bus use the same identifier")]
fn an_rs00_replying_as_a_dm4310_does() {
    joints(|joints| joints[1].motor = rs00(2, 0x11));
}

#[test]
#[should_panic(expected = "two joints on one bus use the same identifier")]
fn two_rs00_with_one_host() {
    joints(|joints| {
        joints[0].motor = rs00(1, 0xFD);
        joints[1].motor = rs00(2, 0xFD);
    });
}

#[test]
#[should_panic(expected = "two joints on one bus use the same identifier")]
fn a_reply_that_is_another_motors_command() {
    joints(|joints| joints[1].motor = dm4310(2, 0x101));
}

#[test]
#[should_panic(expected = "a joint's reply has the identifier of its commands")]
fn a_reply_that_is_the_motors_own_command() {
    joints(|joints| joints[1].motor = dm4310(2, 0x002));
}

/// Its speed commands would have 0x201, the feedback of the left wheel.
#[test]
#[should_panic(expected = "identifier of the wheels' speed controllers")]
fn a_joint_on_the_wheels_bus() {
    joints(|joints| joints[0].bus = BusId::Can1);
}

#[test]
#[should_panic(expected = "identifier of the tuning channel or of register access")]
fn a_reply_on_the_tuning_channel() {
    joints(|joints| joints[0].motor = dm4310(1, 0x7A0));
}

/// MST_ID is 0x302, so joint 2 would answer each report of joint 1.
#[test]
#[should_panic(expected = "has its number in the low byte of the identifier")]
fn a_reply_with_another_dm4310s_number_in_its_low_byte() {
    joints(|joints| joints[0].motor = dm4310(1, 0x302));
}

/// An RS00 compares the whole identifier.
#[test]
fn a_reply_with_an_rs00s_number_in_its_low_byte() {
    joints(|joints| {
        joints[0].motor = dm4310(1, 0x302);
        joints[1].motor = rs00(2, 0xF2);
    });
}

#[test]
#[should_panic(expected = "identifier of the tuning channel or of register access")]
fn a_reply_among_recorded_samples() {
    joints(|joints| joints[0].motor = dm4310(1, 0x7A5));
}

#[test]
#[should_panic(expected = "both wheels have the same number")]
fn two_wheels_with_one_number() {
    let mut wheels = *ROBOT_LAYOUT.wheels();
    wheels.escs[1] = wheels.escs[0];
    MotorLayout::new(&robots::FIVEBAR, wheels, *ROBOT_LAYOUT.joints());
}

/// Four commands and four replies of 135 bits each ms are a load of 108 %.
#[test]
#[should_panic(expected = "CAN2 would be loaded above 80 %")]
fn four_joints_in_every_tick() {
    joints(|joints| {
        for joint in joints {
            joint.schedule = Schedule::new(1, 0).unwrap();
        }
    });
}

#[test]
#[should_panic(expected = "more than two frames for motors on CAN2 in one tick")]
fn three_joints_in_one_tick() {
    joints(|joints| joints[2].schedule = joints[0].schedule);
}

/// The wheels' three frames in each tick are a load of 40.5 %, and two joints in every tick add 54 %.
#[test]
#[should_panic(expected = "CAN1 would be loaded above 80 %")]
fn joints_in_every_tick_beside_the_wheels() {
    joints(|joints| {
        for (number, joint) in (9..).zip(joints.iter_mut().take(2)) {
            joint.bus = BusId::Can1;
            joint.motor = dm4310(number, 0x10 + u16::from(number));
            joint.schedule = Schedule::new(1, 0).unwrap();
        }
    });
}

#[test]
#[should_panic(expected = "a joint's torque limit is beyond what its motor may give")]
fn more_torque_than_the_motor_has() {
    joints(|joints| joints[0].config.max_torque_nm = 7.5);
}

#[test]
fn schedule_periods_are_powers_of_two_up_to_eight() {
    for every in 0..=u8::MAX {
        let allowed = [1, 2, 4, 8].contains(&every);
        assert_eq!(Schedule::new(every, 0).is_some(), allowed, "{every}");
        assert_eq!(Schedule::new(every, every), None);
    }
    let due: Vec<bool> = (0..=255_u8)
        .map(|tick| Schedule::new(4, 3).unwrap().is_due(tick))
        .collect();
    assert!(
        due.chunks(4)
            .all(|ticks| ticks == [false, false, false, true])
    );
}

#[test]
fn a_schedule_s_period_is_in_ticks_of_a_millisecond() {
    for (every, period_s) in [(1, 0.001), (2, 0.002), (8, 0.008)] {
        let schedule = Schedule::new(every, 0).unwrap();
        assert!((schedule.period_s() - period_s).abs() < 1e-9);
    }
}

#[test]
fn both_layouts_have_the_same_stop_frames() {
    assert_eq!(RS00_LAYOUT.safe_frames(), ROBOT_LAYOUT.safe_frames());
}
