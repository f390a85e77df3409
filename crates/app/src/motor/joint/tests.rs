use super::*;
use crate::{
    domain::StandardId,
    motor::{
        dm4310::Register,
        layout::{ROBOT_LAYOUT, RS00_LAYOUT},
        mit::MitReport,
    },
};

/// Joint 0 at its zero with this speed, as reported at 1 s.
fn joint_in(phase: Phase, vel_rps: f32) -> Joint {
    let [slot, ..] = ROBOT_LAYOUT.joints();
    Joint {
        phase,
        report: Some(Report {
            motion: MitReport {
                position_code: 0x8000,
                pos_rad: 0.0,
                vel_rps,
                torque_nm: 0.0,
            },
            temperature_c: 30.0,
            status: Status::Enabled,
        }),
        report_ts_us: 1_000_000,
        ..Joint::new(slot)
    }
}

const ENABLED_PHASE: Phase = Phase::Enabled {
    disabled_replies: 0,
};

const HOLD: JointCommand = JointCommand {
    mode: JointMode::Mit,
    pos_rad: 0.0,
    vel_rps: 0.0,
    kp: 20.0,
    kd: 0.0,
    tau_nm: 0.0,
};

/// The last report is 40 ms old: at 5 rad/s the joint is 0.2 rad on by now, and a stiffness of 20 N·m/rad pulls with
/// 4 N·m there; 3 are allowed.
#[test]
fn torque_is_limited_for_where_a_joint_may_be_since_its_last_report() {
    let mut joint = joint_in(ENABLED_PHASE, 5.0);
    let slot = joint.slot;
    let mut kp_after = |age_us: u64| {
        let now_us = 1_000_000 + age_us;
        joint.watch(50_000, now_us);
        joint.tick = 0;
        joint.drive(&HOLD, &slot.config, true, now_us);
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
        let mut joint = joint_in(ENABLED_PHASE, 0.0);
        for (at_us, status) in (1_002_000..).step_by(2_000).zip(replies) {
            hear(&mut joint, *status, at_us);
        }
        assert_eq!(joint.state(), state, "{replies:?}");
    }
}

#[test]
fn a_reply_as_old_as_allowed_is_no_silence() {
    for (age_us, state) in [(50_000, JointState::Enabled), (50_001, JointState::Silent)] {
        let mut joint = joint_in(ENABLED_PHASE, 0.0);
        joint.watch(50_000, 1_000_000 + age_us);
        assert_eq!(joint.state(), state, "{age_us} us");
    }
}

/// What was sent is what the motor obeys; without a permit that is nothing, also before its next slot.
#[test]
fn without_a_permit_nothing_counts_as_sent() {
    let mut joint = joint_in(ENABLED_PHASE, 0.0);
    let config = joint.slot.config;
    for ms in 1..=2 {
        joint.drive(&HOLD, &config, true, 1_000_000 + ms * 1_000);
    }
    assert_eq!(joint.sent().kp, 20.0);
    joint.drive(&HOLD, &config, true, 1_003_000);
    joint.drive(&HOLD, &config, true, 1_004_000);
    assert_eq!(joint.sent().kp, 20.0);
    let mut joints = [joint.clone(), joint];
    joints[1].tick = joints[1].tick.wrapping_add(1);
    for joint in &mut joints {
        joint.drive(&HOLD, &config, false, 1_005_000);
        assert_eq!(*joint.sent(), JointCommand::default());
    }
}

/// For 10 ms, and again every 250 ms; meanwhile the motor is told to stay off.
#[test]
fn a_joint_that_does_not_follow_is_told_to_enable_only_now_and_then() {
    let mut joint = joint_in(Phase::Disabled, 0.0);
    let slot = joint.slot;
    let mut enabled_ms = Vec::new();
    for ms in 0..300 {
        match joint.drive(&HOLD, &slot.config, true, 1_000_000 + ms * 1_000) {
            Some(frame) if frame == slot.motor.enable() => enabled_ms.push(ms),
            Some(frame) => assert_eq!(frame, slot.motor.disable()),
            None => {}
        }
    }
    let first_ms = enabled_ms[0];
    let expected = [0, 2, 4, 6, 8, 250, 252, 254, 256, 258].map(|ms| first_ms + ms);
    assert_eq!(enabled_ms, expected);
}

/// It may be silent for some 150 ms while it takes a value.
#[test]
fn a_motor_that_is_silent_after_a_write_goes_on_with_its_set_up() {
    let [slot, ..] = ROBOT_LAYOUT.joints();
    let mut set_up = SetUp::new(&slot.motor, JointMode::Mit);
    set_up.on_report(Status::Disabled);
    for value in [
        12.5_f32.to_bits(),
        30.0_f32.to_bits(),
        10.0_f32.to_bits(),
        0,
    ] {
        set_up.request(1_000_000);
        set_up.on_register(value, 1_000_000);
    }
    set_up.request(1_000_000);
    let mut joint = joint_in(Phase::SettingUp(set_up), 0.0);
    for (age_us, expected) in [
        (200_000, Expected::Register(Register::Timeout)),
        (400_000, Expected::Report),
    ] {
        joint.watch(50_000, 1_000_000 + age_us);
        assert_eq!(joint.expected(), expected, "{age_us} us");
    }
}

/// Full speed backwards at the end of the range, in an ordinary reply of motor 1 to host 0xF1.
#[test]
fn an_rs00_names_faults_only_when_asked() {
    let id = StandardId::new(0xF1).unwrap();
    let frame = CanFrame::new(id, [1, 0, 0, 0, 0, 0, 0, 0]);
    let [slot, ..] = RS00_LAYOUT.joints();
    for (said, is_report) in [(Said::Other, true), (Said::ReadFaults, false)] {
        let mut joint = Joint {
            phase: Phase::Disabled,
            said,
            ..Joint::new(slot)
        };
        assert!(joint.receive(&frame, 1_000_000));
        assert_eq!(joint.report.is_some(), is_report, "{said:?}");
    }
}

/// Position 0x8000 + 0x1000 of ±12.5 rad is 1.5627 rad; speed 0x800 is 0.007 rad/s, 0x810 is 0.24 (protocol of the motor).
#[test]
fn only_a_joint_that_is_set_up_and_still_stands_somewhere() {
    let [slot, ..] = ROBOT_LAYOUT.joints();
    let mut joint = Joint::new(slot);
    assert_eq!(joint.standing_angle_rad(), Err(NotStanding::Unknown));
    let hear = |joint: &mut Joint, speed: [u8; 2], at_us| {
        let reply = [0x01, 0x90, 0, speed[0], speed[1], 0, 25, 25];
        let frame = CanFrame::new(StandardId::new(0x11).unwrap(), reply);
        assert!(joint.receive(&frame, at_us));
        joint.watch(50_000, at_us);
    };
    hear(&mut joint, [0x80, 0x08], 1_000);
    assert_eq!(joint.standing_angle_rad(), Err(NotStanding::Unknown));
    joint.phase = Phase::Disabled;
    hear(&mut joint, [0x80, 0x08], 2_000);
    let angle_rad = joint.standing_angle_rad().unwrap();
    assert!((angle_rad - 1.5627).abs() < 1e-3, "{angle_rad}");
    hear(&mut joint, [0x81, 0x08], 3_000);
    assert_eq!(joint.standing_angle_rad(), Err(NotStanding::Turns));
    hear(&mut joint, [0x80, 0x08], 4_000);
    joint.frozen = true;
    assert_eq!(joint.standing_angle_rad(), Err(NotStanding::Unknown));
    joint.frozen = false;
    joint.watch(50_000, 60_000);
    assert_eq!(joint.standing_angle_rad(), Err(NotStanding::Unknown));
}
