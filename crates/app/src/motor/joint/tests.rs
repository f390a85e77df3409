use super::*;
use crate::{
    domain::StandardId,
    motor::{
        dm4310::Register,
        layout::{ROBOT_LAYOUT, RS00_LAYOUT},
        mit::MitReport,
    },
};

/// Joint 0 at its zero with this speed, reported at 1 s.
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

/// The last report is 40 ms old. At 5 rad/s the joint has moved 0.2 rad since, where a stiffness of 20 N·m/rad gives
/// 4 N·m. The limit is set to 3 N·m.
#[test]
fn the_torque_limit_covers_motion_since_the_last_report() {
    let mut joint = joint_in(ENABLED_PHASE, 5.0);
    let config = JointConfig {
        max_torque_nm: 3.0,
        ..joint.slot.config
    };
    let mut kp_after = |age_us: u64| {
        let now_us = 1_000_000 + age_us;
        joint.update_age(50_000, now_us);
        joint.tick = 0;
        joint.drive(&HOLD, &config, true, now_us);
        joint.sent().kp
    };
    assert_eq!(kp_after(2_000), 20.0);
    let kp = kp_after(40_000);
    assert!(kp > 0.0 && kp * 0.2 <= 3.0, "{kp}");
}

/// State of a DM4310, in the upper half of byte 0 (manual, feedback frame).
const DISABLED: u8 = 0x0;
const ENABLED: u8 = 0x1;

/// Receives a reply of the motor at its zero and at rest.
fn receive_reply(joint: &mut Joint, status: u8, at_us: u64) {
    let reply = [status << 4 | 1, 0x80, 0, 0x80, 0x08, 0, 25, 25];
    let frame = CanFrame::new(StandardId::new(0x11).unwrap(), reply);
    assert!(joint.receive(&frame, at_us));
    joint.update_age(50_000, at_us);
}

#[test]
fn a_dm4310_that_keeps_reporting_enabled_does_not_count_as_disabled() {
    let [slot, ..] = ROBOT_LAYOUT.joints();
    let mut joint = Joint::new(slot);
    let mut feedback = JointFeedback::default();
    for (at_us, status) in [(1_000, ENABLED), (2_000, DISABLED), (3_000, ENABLED)] {
        receive_reply(&mut joint, status, at_us);
        joint.feedback(&slot.config, &mut feedback);
        assert_eq!(feedback.state, JointState::SettingUp);
        assert_eq!(feedback.reports_enabled, status == ENABLED);
    }
}

/// One such reply may have been on its way when the motor was enabled. Two in a row mean that the motor lost its
/// supply for a moment.
#[test]
fn two_disabled_replies_of_an_enabled_joint_restart_set_up_and_one_does_not() {
    for (replies, state) in [
        (&[DISABLED][..], JointState::Enabled),
        (&[DISABLED, ENABLED, DISABLED], JointState::Enabled),
        (&[DISABLED, DISABLED], JointState::SettingUp),
        (&[ENABLED, DISABLED, DISABLED], JointState::SettingUp),
    ] {
        let mut joint = joint_in(ENABLED_PHASE, 0.0);
        for (at_us, status) in (1_002_000..).step_by(2_000).zip(replies) {
            receive_reply(&mut joint, *status, at_us);
        }
        assert_eq!(joint.state(), state, "{replies:?}");
    }
}

#[test]
fn a_reply_of_the_maximum_age_is_not_silence() {
    for (age_us, state) in [(50_000, JointState::Enabled), (50_001, JointState::Silent)] {
        let mut joint = joint_in(ENABLED_PHASE, 0.0);
        joint.update_age(50_000, 1_000_000 + age_us);
        assert_eq!(joint.state(), state, "{age_us} us");
    }
}

/// The motor follows what was sent. Without a permit that is nothing, even before its next slot.
#[test]
fn without_a_permit_no_command_counts_as_sent() {
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

/// Enable frames go out for 10 ms every 250 ms. In between the motor gets disable frames.
#[test]
fn a_joint_that_does_not_follow_gets_enable_frames_in_bursts() {
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

/// The motor may be silent for about 150 ms after a write.
#[test]
fn silence_after_a_write_does_not_restart_the_set_up() {
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
        joint.update_age(50_000, 1_000_000 + age_us);
        assert_eq!(joint.expected(), expected, "{age_us} us");
    }
}

/// The word looks like an ordinary reply of motor 1 to host 0xF1 at full speed backwards and at the end of the range. It may come
/// after the replies to later commands, for 8 ms from its request.
#[test]
fn an_rs00_reports_its_faults_only_after_a_request() {
    let id = StandardId::new(0xF1).unwrap();
    let word = CanFrame::new(id, [1, 0, 0, 0, 0, 0, 0, 0]);
    let at_rest = CanFrame::new(id, [1, 0x80, 0, 0x80, 0x08, 0, 0x80, 250]);
    let [slot, ..] = RS00_LAYOUT.joints();
    let is_report = |joint: &Joint| {
        let mut joint = joint.clone();
        joint.report = None;
        assert!(joint.receive(&word, 1_000_000));
        joint.report.is_some()
    };
    let mut joint = Joint {
        phase: ENABLED_PHASE,
        ..Joint::new(slot)
    };
    let mut asked_ms = None;
    for ms in 0..200 {
        let frame = joint.drive(&HOLD, &slot.config, true, 1_000_000 + ms * 1_000);
        if frame == slot.motor.read_faults() {
            asked_ms = Some(ms);
        }
        assert!(joint.receive(&at_rest, 1_000_000 + ms * 1_000));
        assert!(joint.report.is_some_and(|it| it.motion.vel_rps.abs() < 0.1));
        let expected = asked_ms.is_none_or(|asked_ms| ms - asked_ms >= 8);
        assert_eq!(is_report(&joint), expected, "{ms} ms");
    }
    assert!(asked_ms.is_some());
}

/// Position code 0x9000 is 1.5627 rad of ±12.5 rad. Speed code 0x800 is 0.007 rad/s and 0x810 is 0.24 rad/s.
#[test]
fn only_a_set_up_joint_at_rest_has_a_stationary_angle() {
    let [slot, ..] = ROBOT_LAYOUT.joints();
    let mut joint = Joint::new(slot);
    assert_eq!(joint.stationary_angle_rad(), Err(NotStationary::Unknown));
    let receive_reply = |joint: &mut Joint, speed: [u8; 2], at_us| {
        let reply = [0x01, 0x90, 0, speed[0], speed[1], 0, 25, 25];
        let frame = CanFrame::new(StandardId::new(0x11).unwrap(), reply);
        assert!(joint.receive(&frame, at_us));
        joint.update_age(50_000, at_us);
    };
    receive_reply(&mut joint, [0x80, 0x08], 1_000);
    assert_eq!(joint.stationary_angle_rad(), Err(NotStationary::Unknown));
    joint.phase = Phase::Disabled;
    receive_reply(&mut joint, [0x80, 0x08], 2_000);
    let angle_rad = joint.stationary_angle_rad().unwrap();
    assert!((angle_rad - 1.5627).abs() < 1e-3, "{angle_rad}");
    receive_reply(&mut joint, [0x81, 0x08], 3_000);
    assert_eq!(joint.stationary_angle_rad(), Err(NotStationary::Moving));
    receive_reply(&mut joint, [0x80, 0x08], 4_000);
    joint.frozen = true;
    assert_eq!(joint.stationary_angle_rad(), Err(NotStationary::Unknown));
    joint.frozen = false;
    joint.update_age(50_000, 60_000);
    assert_eq!(joint.stationary_angle_rad(), Err(NotStationary::Unknown));
}
