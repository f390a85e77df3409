use super::*;
use crate::{
    domain::StandardId,
    motor::{layout::ROBOT_LAYOUT, mit::MitReport},
};

/// The last report is 40 ms old: at 5 rad/s the joint is 0.2 rad on by now, and a stiffness of 20 N·m/rad pulls with
/// 4 N·m there; 3 are allowed.
#[test]
fn torque_is_limited_for_where_a_joint_may_be_since_its_last_report() {
    let [slot, ..] = ROBOT_LAYOUT.joints();
    let mut joint = Joint {
        phase: Phase::Enabled {
            disabled_replies: 0,
        },
        report: Some(Report {
            motion: MitReport {
                position_code: 0x8000,
                pos_rad: 0.0,
                vel_rps: 5.0,
                torque_nm: 0.0,
            },
            temperature_c: 30.0,
            status: Status::Enabled,
        }),
        report_ts_us: 1_000_000,
        ..Joint::new(slot)
    };
    let hold = JointCommand {
        mode: JointMode::Mit,
        kp: 20.0,
        ..JointCommand::default()
    };
    let mut kp_after = |age_us: u64| {
        let now_us = 1_000_000 + age_us;
        joint.watch(50_000, now_us);
        joint.tick = 0;
        joint.drive(&hold, &slot.config, true, now_us);
        joint.sent().kp
    };
    assert_eq!(kp_after(2_000), 20.0);
    let kp = kp_after(40_000);
    assert!(kp > 0.0 && kp * 0.2 <= 3.0, "{kp}");
}

/// What a DM4310 with number 1 says of itself, in the upper half of byte 0 (its manual, feedback frame).
const DISABLED: u8 = 0x0;
const ENABLED: u8 = 0x1;

/// At its zero, at rest.
fn hear(joint: &mut Joint, status: u8, at_us: u64) {
    let reply = [status << 4 | 1, 0x80, 0, 0x80, 0x08, 0, 25, 25];
    let frame = CanFrame::new(StandardId::new(0x11).unwrap(), reply);
    assert!(joint.receive(&frame, at_us));
    joint.watch(50_000, at_us);
}

#[test]
fn a_dm4310_that_goes_on_reporting_enabled_is_not_taken_for_off() {
    let [slot, ..] = ROBOT_LAYOUT.joints();
    let mut joint = Joint::new(slot);
    let mut feedback = JointFeedback::default();
    for (at_us, status) in [(1_000, ENABLED), (2_000, DISABLED), (3_000, ENABLED)] {
        hear(&mut joint, status, at_us);
        joint.feedback(&slot.config, &mut feedback);
        assert_eq!(feedback.state, JointState::SettingUp);
        assert_eq!(feedback.reports_enabled, status == ENABLED);
    }
}

/// One may have been under way when the motor was enabled; two in a row are a motor that lost its supply for a moment.
#[test]
fn one_late_disabled_reply_of_an_enabled_joint_is_ignored_and_two_start_set_up() {
    for (replies, state) in [
        (&[DISABLED][..], JointState::Enabled),
        (&[DISABLED, ENABLED, DISABLED], JointState::Enabled),
        (&[DISABLED, DISABLED], JointState::SettingUp),
        (&[ENABLED, DISABLED, DISABLED], JointState::SettingUp),
    ] {
        let [slot, ..] = ROBOT_LAYOUT.joints();
        let mut joint = Joint {
            phase: Phase::Enabled {
                disabled_replies: 0,
            },
            ..Joint::new(slot)
        };
        for (at_us, status) in (1_000..).step_by(2_000).zip(replies) {
            hear(&mut joint, *status, at_us);
        }
        assert_eq!(joint.state(), state, "{replies:?}");
    }
}
