//! RS00 frames according to the maker's MIT protocol reference. Floats are IEEE 754, little-endian.

use robot_app::{
    domain::{CanFrame, StandardId},
    motor::{
        mit::{MitCommand, MitTargets},
        rs00::{Faults, RANGES, Rs00, RunMode},
    },
};

fn motor() -> Rs00 {
    Rs00::new(3, 0xFD).unwrap()
}

fn frame(id: u16, payload: &[u8]) -> CanFrame {
    CanFrame::from_payload(StandardId::new(id).unwrap(), payload).unwrap()
}

/// Sections 4.1 to 4.5: bytes 6 and 7, which follow six bytes of FF.
#[test]
fn orders() {
    for (order, detail, code) in [
        (motor().enable(), 0xFF, 0xFC),
        (motor().disable(), 0xFF, 0xFD),
        (motor().set_zero(), 0xFF, 0xFE),
        (motor().clear_fault(), 0xFF, 0xFB),
        (motor().read_faults(), 0x00, 0xFB),
        (motor().set_mode(RunMode::Mit), 0, 0xFC),
        (motor().set_mode(RunMode::Position), 1, 0xFC),
        (motor().set_mode(RunMode::Speed), 2, 0xFC),
    ] {
        assert_eq!(
            order,
            frame(3, &[0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, detail, code])
        );
    }
}

/// A test vector from docs/hardware.md#test-vectors.
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
        frame(3, &[0x8A, 0x2E, 0x7F, 0xF0, 0xA3, 0x33, 0x38, 0x48])
    );
}

#[test]
fn position_and_speed_commands() {
    // 1.5 = 0x3FC00000, 2.0 = 0x40000000, −4.25 = 0xC0880000; 2.96 N·m at 1.48 N·m/A is 2 A.
    assert_eq!(
        motor().position_speed(1.5, 2.0),
        frame(0x103, &[0, 0, 0xC0, 0x3F, 0, 0, 0, 0x40])
    );
    assert_eq!(
        motor().speed(-4.25, 2.96),
        frame(0x203, &[0, 0, 0x88, 0xC0, 0, 0, 0, 0x40])
    );
}

#[test]
fn nan_and_values_out_of_range_are_not_sent() {
    // 33 = 0x42040000.
    let zero = [0; 8];
    assert_eq!(motor().position_speed(f32::NAN, 2.0).payload(), zero);
    assert_eq!(motor().speed(f32::NAN, f32::NAN).payload(), zero);
    assert_eq!(motor().speed(0.0, -1.0).payload(), zero);
    assert_eq!(
        motor().speed(1e9, 0.0).payload(),
        [0, 0, 0x04, 0x42, 0, 0, 0, 0]
    );
}

/// 41.5 °C = 415 = 0x19F, with every meaning the manuals give the bits above.
#[test]
fn replies() {
    for (status, faulty) in [
        (0x01, false),
        (0x81, false),
        (0x91, false),
        (0xA1, true),
        (0xF1, true),
    ] {
        let payload = [3, 0x80, 0x00, 0x80, 0x08, 0x00, status, 0x9F];
        let reply = motor().decode(&frame(0xFD, &payload)).unwrap();
        assert_eq!(reply.temperature_c, 41.5);
        assert_eq!(reply.faulty, faulty, "{status:X}");
        // Half a step above zero: 12.57/65535, 33/4095, 14/4095.
        assert!((reply.motion.pos_rad - 1.918e-4).abs() < 1e-6);
        assert!((reply.motion.vel_rps - 8.059e-3).abs() < 1e-5);
        assert!((reply.motion.torque_nm - 3.419e-3).abs() < 1e-5);
    }
}

/// All motors answer with one identifier, and byte 0 names the motor.
#[test]
fn foreign_and_malformed_replies_are_rejected() {
    let payload = [3, 0x80, 0x00, 0x80, 0x08, 0x00, 0x01, 0x9F];
    assert!(motor().decode(&frame(0xFD, &payload)).is_some());
    assert_eq!(motor().decode(&frame(0xFC, &payload)), None);
    for len in 0..8 {
        assert_eq!(motor().decode(&frame(0xFD, &payload[..len])), None);
    }
    for number in (0..=255).filter(|&number| number != 3) {
        let mut other = payload;
        other[0] = number;
        assert_eq!(motor().decode(&frame(0xFD, &other)), None);
    }
}

#[test]
fn the_fault_word_has_the_documented_bits() {
    let word = |a, b, c, d| motor().decode_faults(&frame(0xFD, &[3, a, b, c, d, 0, 0, 0]));
    for (bit, fault) in [
        (0, Faults::OVER_TEMPERATURE),
        (1, Faults::DRIVER_CHIP),
        (2, Faults::UNDER_VOLTAGE),
        (3, Faults::OVER_VOLTAGE),
        (4, Faults::PHASE_B_CURRENT),
        (5, Faults::PHASE_C_CURRENT),
        (7, Faults::ENCODER_NOT_CALIBRATED),
        (8, Faults::HARDWARE_IDENTIFICATION),
        (9, Faults::POSITION_INITIALISATION),
        (14, Faults::STALL_OVERLOAD),
        (16, Faults::PHASE_A_CURRENT),
    ] {
        let [a, b, c, d] = (1_u32 << bit).to_le_bytes();
        let faults = word(a, b, c, d).unwrap();
        assert_eq!(faults.bits(), 1 << bit);
        assert_eq!(faults, fault);
    }
    assert_eq!(word(0, 0, 0, 0), Some(Faults::default()));
}

/// After a lost answer the next ordinary reply must not count as a fault word.
#[test]
fn an_ordinary_reply_is_not_taken_for_a_fault_word() {
    for velocity in 0x020..=0xFFF_u16 {
        for position in [0_u16, 1, 0x7FFF, 0x8000, 0xFFFF] {
            let [p_high, p_low] = position.to_be_bytes();
            let [v_high, v_low] = (velocity << 4).to_be_bytes();
            let reply = frame(0xFD, &[3, p_high, p_low, v_high, v_low | 8, 0, 1, 0x9F]);
            assert_eq!(motor().decode_faults(&reply), None);
        }
    }
}

#[test]
fn impossible_motors_are_rejected() {
    assert_eq!(Rs00::new(0, 0xFD), None);
    assert_eq!(Rs00::new(128, 0xFD), None);
}
