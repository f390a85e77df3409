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

/// The upper half of byte 0 is the motor's state, 1 = enabled (its manual, feedback frame).
#[test]
fn a_dm4310_that_goes_on_reporting_enabled_is_not_taken_for_off() {
    let [slot, ..] = ROBOT_LAYOUT.joints();
    let mut joint = Joint::new(slot);
    let mut feedback = JointFeedback::default();
    for (at_us, first, reports_enabled) in [
        (1_000, 0x11, true),
        (2_000, 0x01, false),
        (3_000, 0x11, true),
    ] {
        let reply = [first, 0x80, 0, 0x80, 0x08, 0, 25, 25];
        let frame = CanFrame::new(StandardId::new(0x11).unwrap(), reply);
        assert!(joint.receive(&frame, at_us));
        joint.watch(50_000, at_us);
        joint.feedback(&slot.config, &mut feedback);
        assert_eq!(feedback.state, JointState::SettingUp);
        assert_eq!(feedback.reports_enabled, reports_enabled);
    }
}
