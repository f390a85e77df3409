//! Checks the words and the JSON for states that the tests make up.

use robot_app::{
    diagnostics::DiagnosticsSnapshot,
    domain::{CrashCause, JointState, ResetCause},
    safety::{ArmingBlockers, ArmingState, SafetyFlags, SafetyVerdict},
};

use super::*;
use crate::tuning::testing;

fn status(fill: impl FnOnce(&mut DiagnosticsSnapshot)) -> Status {
    Status::read(&mut testing::client(fill)).unwrap()
}

#[test]
fn arming_blockers_are_shown_with_advice() {
    let text = status(|diagnostics| {
        diagnostics.reset_cause = ResetCause::IndependentWatchdog;
        diagnostics.last_words = CrashCause::ImuLate;
        diagnostics.ts_us = 3_661_000_000;
        diagnostics.battery_v = 23.994;
        let joint = &mut diagnostics.sensors.motor.joints[1];
        (joint.state, joint.ts_us, joint.pos_rad) = (JointState::Fault, 1, -0.5);
        (joint.temperature_c, joint.fault_code) = (41.0, 0xD);
        diagnostics.params.strange_sectors = 2;
    })
    .to_string();
    for line in [
        "firmware    0.2.0, joints dm4310, up 1:01:01 h",
        "last reset  watchdog, before it: task imu was late",
        "state       disarmed",
        "stopped     everything",
        "battery     23.99 V",
        "wheel left         NEVER HEARD",
        "joint left-rear    fault, -0.500 rad, 41 degC, fault code 0xD",
        "joint right-rear   silent",
        "2 flash sectors for settings hold something else",
    ] {
        assert!(text.contains(line), "`{line}` in\n{text}");
    }
    assert!(!text.contains("RUINED"), "{text}");
}

#[test]
fn the_motor_that_prevents_arming_is_named_with_unknown_identifiers() {
    let text = status(|diagnostics| {
        diagnostics.arming.refused = ArmingBlockers::WHEEL_NEVER_HEARD;
        diagnostics.motors.wheels_doubtful = 0b10;
        diagnostics.motors.joints_outside = 0b100;
        let joint = &mut diagnostics.sensors.motor.joints[2];
        (joint.state, joint.ts_us, joint.pos_rad) = (JointState::Disabled, 1, 6.5);
        let strangers = &mut diagnostics.strangers.buses[0];
        (strangers.frames, strangers.last_id, strangers.esc_id) = (9, 0x123, 0x205);
    })
    .to_string();
    for line in [
        "the last flip of enable was refused: wheel-never-heard\n",
        "wheel right        NEVER HEARD, TWO MOTORS WITH ITS NUMBER",
        "joint right-front  disabled, +6.500 rad, 0 degC, OUT OF ITS LIMITS",
        "heard and meant for nobody: 0x123; 0x205 is a C620 with number 5\n",
    ] {
        assert!(text.contains(line), "`{line}` in\n{text}");
    }
}

#[test]
fn an_armed_robot_has_no_blockers() {
    let text = status(|diagnostics| {
        diagnostics.arming.state = ArmingState::Armed;
        diagnostics.safety.verdict = SafetyVerdict::Run;
        diagnostics.params.lost_sectors = 1;
    })
    .to_string();
    assert!(text.contains("state       armed\n"), "{text}");
    assert!(text.contains("stopped     nothing\n"), "{text}");
    assert!(!text.contains("what keeps it"), "{text}");
    assert!(
        text.contains("RUINED SECTORS   1: newer values may be lost"),
        "{text}"
    );
}

#[test]
fn json_has_every_value_by_name() {
    let json = status(|diagnostics| {
        diagnostics.battery_v = 23.5;
        diagnostics.sensors.motor.wheels[1].rotor_angle = 8_000;
    })
    .to_json();
    assert_eq!(json["power"]["battery-v"], 23.5);
    assert_eq!(json["joint"]["left-front"]["state"], "silent");
    assert_eq!(
        json["joint"]["left-front"]["angle-rad"],
        serde_json::Value::Null
    );
    assert_eq!(json["wheel-motor"]["right"]["rotor-angle"], 8_000);
    assert_eq!(json["safety"]["stopped"][0], "wheels");
    assert_eq!(json["settings"]["saved"], true);
    assert_eq!(json["found-at-boot"]["ruined-sectors"], 0);
}

#[test]
fn the_pc_link_is_shown_with_what_it_loses() {
    let text = status(|diagnostics| {
        diagnostics.ts_us = 5_000_000;
        let link = &mut diagnostics.link;
        (link.good, link.sent, link.rate_hz) = (321, 4_000, 99.7);
        link.longest_gap_us = 12_900;
        diagnostics.pc_age_us = 7_000;
    })
    .to_string();
    let line = "PC          100 Hz, last command 7 ms ago, longest gap 12 ms; 321 frames received, 4000 sent\n";
    assert!(text.contains(line), "{text}");
    assert!(!text.contains("PC line"), "{text}");
    let text = status(|diagnostics| {
        diagnostics.pc_age_us = u32::MAX;
        let link = &mut diagnostics.link;
        (link.crc_errors, link.line_errors) = (3, 1);
        (link.resyncs, link.unconfirmed) = (2, 2);
    })
    .to_string();
    for line in [
        "PC          no command yet, or none for a minute; 0 frames received, 0 sent\n",
        "PC line     3 CRC errors, 1 line errors, 2 resyncs, 2 commands not used\n",
    ] {
        assert!(text.contains(line), "`{line}` in\n{text}");
    }
}

/// The joints stay enabled then, and the motors say so.
#[test]
fn without_a_fresh_command_of_the_pc_nothing_has_torque() {
    let text = status(|diagnostics| {
        diagnostics.arming.state = ArmingState::Armed;
        diagnostics.safety.verdict = SafetyVerdict::Run;
        diagnostics.safety.flags = SafetyFlags::PC_LOST;
        let [first, second, ..] = &mut diagnostics.sensors.motor.joints;
        for (joint, state) in [(first, JointState::Enabled), (second, JointState::Disabled)] {
            (joint.state, joint.ts_us, joint.reports_enabled) = (state, 1, true);
        }
    })
    .to_string();
    for line in [
        "stopped     wheels and joints, without torque (pc-lost)\n",
        "joint left-front   enabled, +0.000 rad, 0 degC\n",
        "joint left-rear    disabled, +0.000 rad, 0 degC, BUT REPORTS THAT IT IS ENABLED\n",
    ] {
        assert!(text.contains(line), "`{line}` in\n{text}");
    }
}
