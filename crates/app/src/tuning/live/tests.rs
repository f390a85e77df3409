//! Bytes written by hand from the table in docs/tuning.md.

use super::*;
use crate::{
    domain::{BalanceState, BalanceStatus, CrashCause, JointState, ResetCause, StandPermit},
    motor::layout::{ROBOT_LAYOUT, RS00_LAYOUT},
    safety::{ArmingState, SafetyFlags},
};

fn read_of(number: u8, fill: impl FnOnce(&mut DiagnosticsSnapshot)) -> [u8; PAGE_BYTES] {
    let mut diagnostics = DiagnosticsSnapshot::default();
    fill(&mut diagnostics);
    let source = LiveSource {
        diagnostics: &diagnostics,
        layout: &ROBOT_LAYOUT,
    };
    read(number, &source).unwrap()
}

fn page(name: &str) -> &'static LivePage {
    LIVE_PAGES.iter().find(|page| page.name == name).unwrap()
}

fn value(page: &LivePage, bytes: [u8; PAGE_BYTES], field: &str) -> LiveValue {
    let found = page.unpack(bytes).find(|(f, _)| f.name == field);
    found.unwrap().1
}

#[test]
fn numbers_and_names_are_unique_and_fields_fit() {
    let mut numbers = Vec::new();
    let mut names = Vec::new();
    for page in &LIVE_PAGES {
        numbers.extend((0..page.parts.len()).map(|part| page.number(part).unwrap()));
        names.push(page.name);
        let bits: u32 = page.fields.iter().map(|field| u32::from(field.bits)).sum();
        assert!(bits <= 48, "{}: {bits} bits", page.name);
        for field in page.fields {
            assert!((1..=32).contains(&field.bits));
            if let LiveKind::Choice { names, .. } = field.kind {
                assert!(names.len() <= 1 << field.bits, "{}", field.name);
            }
            let same = |other: &&LiveField| other.name == field.name;
            assert_eq!(page.fields.iter().filter(same).count(), 1);
        }
    }
    let count = numbers.len();
    assert!(numbers.is_sorted(), "by number");
    numbers.dedup();
    names.sort_unstable();
    names.dedup();
    assert_eq!((numbers.len(), names.len()), (count, LIVE_PAGES.len()));
}

/// Blockers 0 and 11 = 0x801; state 1.
#[test]
fn a_set_and_a_choice_are_packed_side_by_side() {
    let bytes = read_of(0x03, |diagnostics| {
        diagnostics.arming.state = ArmingState::Armed;
    });
    assert_eq!(bytes, [0, 0, 0, 0, 1, 0]);
    let arming = page("arming");
    assert_eq!(
        value(arming, bytes, "state"),
        LiveValue::Choice(Ok("armed"))
    );
    let bytes = [0x01, 0x08, 0, 0, 3, 0];
    assert_eq!(value(arming, bytes, "state"), LiveValue::Choice(Err(3)));
    assert_eq!(value(arming, bytes, "blockers"), LiveValue::Set(0x801));
    let LiveKind::Set { name_of, .. } = arming.fields[0].kind else {
        panic!("blockers are a set");
    };
    let named = [0, 11].map(|bit| name_of(bit).unwrap());
    assert_eq!(named, ["remote-not-fresh", "settings-refused"]);
    assert_eq!(name_of(31), None);
}

/// −1.2503 rad = −1250 = 0xFB1E, 2.5 rad/s = 250 = 0x00FA, state 2 in the low four bits of byte 4, mark 1 in bit 5.
#[test]
fn a_joint_is_shown_with_sign_and_state() {
    let bytes = read_of(0x22, |diagnostics| {
        let joint = &mut diagnostics.sensors.motor.joints[2];
        joint.pos_rad = -1.2503;
        joint.vel_rps = 2.5;
        joint.state = JointState::Disabled;
        joint.reports_enabled = true;
        joint.ts_us = 1;
    });
    assert_eq!(bytes, [0x1E, 0xFB, 0xFA, 0x00, 0x22, 0]);
    let joint = page("joint");
    assert_eq!(
        value(joint, bytes, "angle-rad"),
        LiveValue::Measure(Some(-1.25))
    );
    assert_eq!(
        value(joint, bytes, "state"),
        LiveValue::Choice(Ok("disabled"))
    );
    assert_eq!(value(joint, bytes, "marks"), LiveValue::Set(0b10));
}

/// 0.1 rad = 5.73°.
#[test]
fn each_axis_shows_its_measurement_after_the_first_sample() {
    for (name, expected) in [
        ("accel", [1.0, -2.0, 3.0]),
        ("gyro", [10.0, -20.0, 30.0]),
        ("gyro-bias", [0.1, -0.2, 0.3]),
        ("mag", [40.0, -50.0, 60.0]),
        ("attitude", [5.73, -11.46, 17.19]),
    ] {
        let page = page(name);
        for ts_us in [0, 1] {
            let bytes = read_of(page.first, |diagnostics| {
                let DiagnosticsSnapshot {
                    sensors, estimate, ..
                } = diagnostics;
                sensors.imu.accel_mps2 = [1.0, -2.0, 3.0];
                sensors.imu.gyro_dps = [10.0, -20.0, 30.0];
                sensors.imu.gyro_bias_dps = [0.1, -0.2, 0.3];
                sensors.mag.mag_ut = [40.0, -50.0, 60.0];
                estimate.rpy_rad = [0.1, -0.2, 0.3];
                (sensors.imu.ts_us, sensors.mag.ts_us) = (ts_us, ts_us);
                estimate.ts_us = ts_us;
            });
            let shown: Vec<_> = page.unpack(bytes).map(|(_, value)| value).collect();
            let expected = expected.map(|value| LiveValue::Measure((ts_us != 0).then_some(value)));
            assert_eq!(shown, expected, "{name}");
        }
    }
}

/// −500 rpm = 0xFE0C, 41 °C, 7 ms; angle 8,191 = 0x1FFF, 2,000 mA = 0x07D0. 0x8000 and 0x100 mean unknown.
#[test]
fn a_wheel_is_shown_after_its_first_report() {
    let shown = |page: u8, side: usize, ts_us| {
        read_of(page, |diagnostics| {
            let wheel = &mut diagnostics.sensors.motor.wheels[side];
            (wheel.rpm, wheel.current_ma) = (-500, 2_000.0);
            (wheel.rotor_angle, wheel.temperature_c) = (8_191, 41);
            (wheel.age_us, wheel.ts_us) = (7_900, ts_us);
        })
    };
    assert_eq!(shown(0x29, 1, 1), [0x0C, 0xFE, 41, 7 << 1, 0, 0]);
    assert_eq!(shown(0x28, 0, 0), [0x00, 0x80, 0x00, 7 << 1 | 1, 0, 0]);
    assert_eq!(shown(0x2B, 1, 1), [0xFF, 0x1F, 0xD0, 0x07, 0, 0]);
    assert_eq!(shown(0x2A, 0, 0), [0xFF, 0x1F, 0x00, 0x80, 0, 0]);
}

/// The lowest number of eight bits is −128 °C.
#[test]
fn a_silent_joint_has_an_unknown_temperature() {
    for (state, ts_us, byte) in [
        (JointState::Disabled, 1, 25),
        (JointState::Silent, 1, 0x80),
        (JointState::Disabled, 0, 0x80),
    ] {
        let bytes = read_of(0x25, |diagnostics| {
            let joint = &mut diagnostics.sensors.motor.joints[1];
            (joint.state, joint.ts_us, joint.temperature_c) = (state, ts_us, 25.0);
        });
        assert_eq!(bytes[0], byte, "{state:?}");
    }
}

#[test]
fn marks_have_their_names() {
    let marks = page("joint")
        .fields
        .iter()
        .find(|field| field.name == "marks");
    let LiveKind::Set { name_of, .. } = marks.unwrap().kind else {
        panic!("marks are a set");
    };
    let named = [0, 1, 2].map(name_of);
    assert_eq!(named, [Some("frozen"), Some("gives-torque"), None]);
}

#[test]
fn each_part_of_a_page_has_a_number() {
    let joint = page("joint");
    let numbers = [0, 3, 4, 256].map(|part| joint.number(part));
    assert_eq!(numbers, [Some(0x20), Some(0x23), None, None]);
}

#[test]
fn channels_are_unknown_before_the_first_frame() {
    let channels = read_of(0x10, |diagnostics| diagnostics.remote.channels = [0.5; 16]);
    let mut values = page("channels").unpack(channels);
    assert!(values.all(|(_, value)| value == LiveValue::Measure(None)));
}

/// The lowest number, 0x8000, is reserved for unknown values.
#[test]
fn unknown_values_are_decoded_as_none() {
    let bytes = read_of(0x22, |_| {});
    assert_eq!(bytes, [0x00, 0x80, 0x00, 0x80, 0, 0]);
    let joint = page("joint");
    assert_eq!(value(joint, bytes, "angle-rad"), LiveValue::Measure(None));
    let power = read_of(0x07, |_| {});
    assert_eq!(
        value(page("power"), power, "battery-v"),
        LiveValue::Measure(None)
    );
}

/// 40 rad is beyond 32.767, 300,000 ms beyond 255, and 5,000 errors beyond 12 bits.
#[test]
fn values_out_of_range_saturate() {
    let bytes = read_of(0x20, |diagnostics| {
        let joint = &mut diagnostics.sensors.motor.joints[0];
        (joint.pos_rad, joint.vel_rps) = (40.0, -400.0);
        (joint.state, joint.ts_us) = (JointState::Disabled, 1);
    });
    assert_eq!(bytes[..4], [0xFF, 0x7F, 0x01, 0x80]);
    let bytes = read_of(0x24, |diagnostics| {
        diagnostics.sensors.motor.joints[0].age_us = 300_000_000;
    });
    assert_eq!(bytes[5], 255);
    let bytes = read_of(0x1A, |diagnostics| {
        diagnostics.imu_status.rejects.frozen = 5_000;
        diagnostics.imu_status.rejects.implausible = 1;
    });
    assert_eq!(bytes, [0x00, 0xF0, 0xFF, 0x01, 0x00, 0x00]);
}

/// Version 0.2.0 of the workspace; make 1 is the DM4310 and 2 the RS00 (docs/parameters.md); 3,661 s = 0x0E4D.
#[test]
fn version_and_uptime_are_shown() {
    assert_eq!(read_of(0x00, |_| {}), [0, 2, 0, 1, 0, 0]);
    let diagnostics = DiagnosticsSnapshot::default();
    let rs00 = LiveSource {
        diagnostics: &diagnostics,
        layout: &RS00_LAYOUT,
    };
    assert_eq!(read(0, &rs00).unwrap()[3], 2);
    let bytes = read_of(0x01, |diagnostics| {
        diagnostics.ts_us = 3_661_900_000;
        diagnostics.tick.missed = 258;
    });
    assert_eq!(bytes, [0x4D, 0x0E, 0, 0, 2, 1]);
}

#[test]
fn choices_have_the_firmware_s_names() {
    let boot = page("boot");
    for code in 0..=255 {
        let bytes = [code << 4, code >> 4, 0, 0, 0, 0];
        let name = CrashCause::from_code(code)
            .map(CrashCause::text)
            .ok_or(code.into());
        assert_eq!(value(boot, bytes, "last-words"), LiveValue::Choice(name));
    }
    let bytes = read_of(0x02, |diagnostics| {
        diagnostics.reset_cause = ResetCause::IndependentWatchdog;
    });
    assert_eq!(
        value(boot, bytes, "reset-cause"),
        LiveValue::Choice(Ok("watchdog"))
    );
}

/// Flags 1 and 25 are set, and wheels and CAN2 stopped.
#[test]
fn stops_are_shown() {
    let bytes = read_of(0x04, |diagnostics| {
        let safety = &mut diagnostics.safety;
        safety.flags = SafetyFlags::REMOTE_FAILSAFE.union(SafetyFlags::JOINT_NOT_READY);
        safety.joints_stop = false;
        safety.bus_stop = [false, true];
    });
    assert_eq!(bytes, [0x02, 0, 0, 0x02, 0b0010_0110, 0]);
}

/// 1, −1, 0.5 and 0 in 12 bits each: 0x3E8, 0xC18, 0x1F4, 0.
#[test]
fn channels_are_four_a_page() {
    let bytes = read_of(0x11, |diagnostics| {
        diagnostics.remote.channels[4..8].copy_from_slice(&[1.0, -1.0, 0.5, 0.0]);
        diagnostics.remote.ts_us = 1;
    });
    assert_eq!(bytes, [0xE8, 0x83, 0xC1, 0xF4, 0x01, 0x00]);
}

/// 99.7 Hz = 997 = 0x03E5, 7 ms, 12 ms; 321 = 0x141 and 4,000 = 0xFA0 frames; 3, 2, 1 and 5 errors of 12 bits each;
/// 9 and 4 tunnelled frames, 70,000 bytes = 0x11170.
#[test]
fn the_pc_link_is_shown() {
    let shown = |page| {
        read_of(page, |diagnostics| {
            diagnostics.ts_us = 5_000_000;
            diagnostics.pc_age_us = 7_000;
            let link = &mut diagnostics.link;
            (link.rate_hz, link.longest_gap_us) = (99.7, 12_900);
            // As of the last exchange, two reports ago.
            link.last_us = 4_973_000;
            (link.good, link.sent) = (321, 4_000);
            (link.crc_errors, link.resyncs) = (3, 2);
            (link.line_errors, link.unconfirmed) = (1, 5);
            (link.tunnelled, link.tunnel_dropped) = (9, 4);
            link.discarded_bytes = 70_000;
        })
    };
    assert_eq!(shown(0x38), [0xE5, 0x03, 7, 0, 12, 0]);
    assert_eq!(shown(0x39), [0x41, 0x01, 0, 0xA0, 0x0F, 0]);
    assert_eq!(shown(0x3A), [0x03, 0x20, 0x00, 0x01, 0x50, 0x00]);
    assert_eq!(shown(0x3B), [9, 0, 0x04, 0x00, 0x17, 0x11]);
    let never = read_of(0x38, |diagnostics| diagnostics.pc_age_us = u32::MAX);
    assert_eq!(never, [0, 0, 0xFF, 0xFF, 0, 0]);
}

#[test]
fn unknown_pages_are_refused() {
    let diagnostics = DiagnosticsSnapshot::default();
    let source = LiveSource {
        diagnostics: &diagnostics,
        layout: &ROBOT_LAYOUT,
    };
    for number in [0x1F, 0x32, 0xFF] {
        assert_eq!(read(number, &source), Err(Refusal::UnknownParameter));
    }
}

proptest::proptest! {
    /// Whatever numbers a table has, they are recovered from their bits.
    #[test]
    fn every_page_is_unpacked_completely(bytes in proptest::prelude::any::<[u8; 6]>()) {
        for page in &LIVE_PAGES {
            proptest::prop_assert_eq!(page.unpack(bytes).count(), page.fields.len());
        }
    }
}

/// State 2, request 4 = 32, airborne = 64; 180 mm = 0xB4 from bit 8, 511 mm at most from bit 17; −0.25 rad = −125 = 0x783
/// from bit 26 and 0.5 rad = 250 from bit 37.
#[test]
fn a_balancing_robot_is_shown_with_its_legs() {
    let bytes = read_of(0x3C, |diagnostics| {
        diagnostics.safety.stand = StandPermit::Standing;
        diagnostics.balance = BalanceStatus {
            state: BalanceState::Balance,
            airborne: true,
            leg_m: [0.1804, 0.9],
            lean_rad: [-0.25, 0.5],
            ..BalanceStatus::SIT
        };
    });
    let number = 2 | 4 << 3 | 1 << 6 | 180 << 8 | 511 << 17 | 0x783 << 26 | 250_u64 << 37;
    assert_eq!(bytes, number.to_le_bytes()[..6]);
}
