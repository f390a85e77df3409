//! DM4310 frames by the tables of docs/hardware.md#dm4310-frames; floats by IEEE 754, little-endian.

use robot_app::{
    domain::{CanFrame, StandardId},
    motor::{
        dm4310::{ControlMode, Dm4310, Register, Status},
        mit::{MitCommand, MitRanges, MitTargets},
    },
};

const RANGES: MitRanges = MitRanges {
    p_max_rad: 12.5,
    v_max_rps: 30.0,
    t_max_nm: 10.0,
};

fn motor() -> Dm4310 {
    Dm4310::new(3, 0x13, RANGES).unwrap()
}

fn frame(id: u16, payload: &[u8]) -> CanFrame {
    CanFrame::from_payload(StandardId::new(id).unwrap(), payload).unwrap()
}

#[test]
fn orders() {
    for (order, code) in [
        (motor().enable(), 0xFC),
        (motor().disable(), 0xFD),
        (motor().set_zero(), 0xFE),
        (motor().clear_fault(), 0xFB),
    ] {
        assert_eq!(
            order,
            frame(3, &[0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, code])
        );
    }
}

/// A vector of docs/hardware.md#test-vectors.
#[test]
fn mit_command() {
    let targets = MitTargets {
        pos_rad: 1.0,
        vel_rps: 0.0,
        kp: 20.0,
        kd: 1.0,
        torque_nm: 0.5,
    };
    assert_eq!(
        motor().mit(MitCommand::clamped(&targets, &RANGES)),
        frame(3, &[0x8A, 0x3C, 0x7F, 0xF0, 0xA3, 0x33, 0x38, 0x65])
    );
}

#[test]
fn position_speed_and_speed_commands() {
    // 1.5 = 0x3FC00000, 2.0 = 0x40000000, −4.25 = 0xC0880000.
    assert_eq!(
        motor().position_speed(1.5, 2.0),
        frame(0x103, &[0, 0, 0xC0, 0x3F, 0, 0, 0, 0x40])
    );
    assert_eq!(
        motor().speed(-4.25),
        frame(0x203, &[0, 0, 0x88, 0xC0, 0, 0, 0, 0])
    );
}

#[test]
fn nan_and_values_out_of_range_are_not_sent() {
    // 12.5 = 0x41480000, 30 = 0x41F00000.
    let zero = [0; 8];
    assert_eq!(motor().position_speed(f32::NAN, 2.0).payload(), zero);
    assert_eq!(motor().position_speed(0.0, f32::NAN).payload(), zero);
    assert_eq!(motor().position_speed(0.0, -1.0).payload(), zero);
    assert_eq!(motor().speed(f32::NAN).payload(), zero);
    assert_eq!(
        motor()
            .position_speed(f32::NEG_INFINITY, f32::INFINITY)
            .payload(),
        [0, 0, 0x48, 0xC1, 0, 0, 0xF0, 0x41]
    );
    assert_eq!(motor().speed(1e9).payload()[..4], [0, 0, 0xF0, 0x41]);
}

#[test]
fn register_access() {
    for (register, index) in [
        (Register::Timeout, 9),
        (Register::ControlMode, 10),
        (Register::PositionRange, 0x15),
        (Register::VelocityRange, 0x16),
        (Register::TorqueRange, 0x17),
    ] {
        assert_eq!(
            motor().read_register(register),
            frame(0x7FF, &[3, 0, 0x33, index, 0, 0, 0, 0])
        );
    }
    // 2000 = 0x7D0.
    assert_eq!(
        motor().write_register(Register::Timeout, 2_000),
        frame(0x7FF, &[3, 0, 0x55, 9, 0xD0, 0x07, 0, 0])
    );
    assert_eq!(
        motor().write_register(Register::ControlMode, ControlMode::Speed as u32),
        frame(0x7FF, &[3, 0, 0x55, 10, 3, 0, 0, 0])
    );
}

#[test]
fn register_answers() {
    let answer =
        |payload: [u8; 8]| motor().decode_register(&frame(0x13, &payload), Register::PositionRange);
    // 12.5 = 0x41480000.
    let value = Some(12.5_f32.to_bits());
    assert_eq!(answer([3, 0, 0x33, 0x15, 0, 0, 0x48, 0x41]), value);
    assert_eq!(answer([3, 0, 0x55, 0x15, 0, 0, 0x48, 0x41]), value);
    assert_eq!(answer([3, 0, 0x33, 0x16, 0, 0, 0x48, 0x41]), None);
    assert_eq!(answer([4, 0, 0x33, 0x15, 0, 0, 0x48, 0x41]), None);
    assert_eq!(answer([3, 1, 0x33, 0x15, 0, 0, 0x48, 0x41]), None);
    assert_eq!(answer([3, 0, 0x34, 0x15, 0, 0, 0x48, 0x41]), None);
}

/// As a reply, each would mean a disabled motor near −12.5 rad.
#[test]
fn a_late_register_answer_is_not_taken_for_a_reply() {
    for order in [0x33, 0x55] {
        for index in [9, 10, 0x15, 0x16, 0x17] {
            let answer = frame(0x13, &[3, 0, order, index, 0xD0, 0x07, 0, 0]);
            assert_eq!(motor().decode(&answer), None);
        }
        assert!(
            motor()
                .decode(&frame(0x13, &[3, 0, order, 0x7F, 0xF7, 0xFF, 41, 52]))
                .is_some()
        );
    }
}

/// Status, the driver's and the winding's temperature; angle, speed and torque are the codes half a step below zero.
#[test]
fn replies() {
    let documented = [
        (0, Status::Disabled),
        (1, Status::Enabled),
        (8, Status::OverVoltage),
        (9, Status::UnderVoltage),
        (0xA, Status::OverCurrent),
        (0xB, Status::DriverTooHot),
        (0xC, Status::WindingTooHot),
        (0xD, Status::CommunicationLost),
        (0xE, Status::Overload),
    ];
    for nibble in 0..16 {
        let payload = [nibble << 4 | 3, 0x7F, 0xFF, 0x7F, 0xF7, 0xFF, 41, 52];
        let reply = motor().decode(&frame(0x13, &payload));
        let expected = documented
            .iter()
            .find(|(code, _)| *code == nibble)
            .map(|(_, status)| *status);
        assert_eq!(reply.map(|reply| reply.status), expected, "{nibble:X}");
        let Some(reply) = reply else { continue };
        assert_eq!((reply.driver_c, reply.winding_c), (41, 52));
        assert!((reply.motion.pos_rad + 1.9e-4).abs() < 1e-5);
        assert!((reply.motion.vel_rps + 7.3e-3).abs() < 1e-4);
        assert!((reply.motion.torque_nm + 2.4e-3).abs() < 1e-4);
        let fault = if nibble >= 8 { u32::from(nibble) } else { 0 };
        assert_eq!(reply.status.fault_code(), fault);
    }
}

#[test]
fn foreign_and_malformed_replies_are_rejected() {
    let payload = [0x13, 0x7F, 0xFF, 0x7F, 0xF7, 0xFF, 41, 52];
    assert!(motor().decode(&frame(0x13, &payload)).is_some());
    assert_eq!(motor().decode(&frame(0x14, &payload)), None);
    for len in 0..8 {
        assert_eq!(motor().decode(&frame(0x13, &payload[..len])), None);
    }
    for number in (0..16).filter(|&number| number != 3) {
        let mut other = payload;
        other[0] = 0x10 | number;
        assert_eq!(motor().decode(&frame(0x13, &other)), None);
    }
}

#[test]
fn impossible_motors_are_rejected() {
    let none = MitRanges {
        p_max_rad: 0.0,
        ..RANGES
    };
    assert_eq!(Dm4310::new(0, 0x13, RANGES), None);
    assert_eq!(Dm4310::new(16, 0x13, RANGES), None);
    assert_eq!(Dm4310::new(3, 0x800, RANGES), None);
    assert_eq!(Dm4310::new(3, 0x13, none), None);
}
