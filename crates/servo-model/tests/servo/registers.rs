//! Registers over the wire: identity, lock, answers.

use robot_servo_model::{Fault, Servo, Version};

use crate::host::{Host, SECOND_NS, frame};

const ID: u8 = 5;
const BAUD: u8 = 6;
const RESPONSE_LEVEL: u8 = 8;
const OFFSET: u8 = 31;
const TORQUE: u8 = 40;
const GOAL: u8 = 42;
const LOCK: u8 = 55;
const POSITION: u8 = 56;

#[test]
fn a_new_servo_has_the_values_of_the_memory_table() {
    let mut host = Host::with_one();
    for (address, wanted) in [
        (ID, 1),
        (BAUD, 0),
        (RESPONSE_LEVEL, 1),
        (13, 70),
        (14, 140),
        (15, 40),
        (21, 32),
        (33, 0),
        (34, 20),
        (35, 200),
        (36, 80),
        (TORQUE, 0),
        (LOCK, 1),
    ] {
        assert_eq!(host.read_u8(1, address), wanted, "{address}");
    }
    for (address, wanted) in [
        (3, 777),
        (9, 0),
        (11, 4095),
        (16, 1000),
        (48, 1000),
        (POSITION, 2048),
    ] {
        assert_eq!(host.read_u16(1, address), wanted, "{address}");
    }
}

// Users lose their calibration: it was written while the lock was shut.
#[test]
fn an_offset_written_under_lock_is_lost_when_the_servo_is_plugged_in_again() {
    let mut host = Host::with_one();
    for (lock, after) in [(1, 0), (0, 300)] {
        host.write(1, LOCK, &[lock]);
        host.write_u16(1, OFFSET, 300);
        assert_eq!(host.read_u16(1, POSITION), 2048 - 300);
        host.wire.fault_for(Fault::Gone { servo: 0 }, SECOND_NS);
        assert_eq!(host.ask(1, 1, &[]), None, "it is unplugged");
        host.wait_s(1.0);
        assert_eq!(host.read_u16(1, OFFSET), after);
        assert_eq!(host.read_u8(1, LOCK), 1);
    }
}

#[test]
fn a_new_id_is_in_force_after_the_answer_that_still_has_the_old_one() {
    let mut host = Host::with_one();
    assert_eq!(host.ask(1, 3, &[ID, 7]), Some((0, vec![])));
    assert_eq!(host.ask(1, 1, &[]), None);
    assert_eq!(host.ask(7, 1, &[]), Some((0, vec![])));
    // 254 is everyone, and nobody's.
    host.write(7, ID, &[254]);
    assert_eq!(host.read_u8(7, ID), 7);
}

#[test]
fn a_new_baud_rate_is_in_force_after_the_answer_that_still_has_the_old_one() {
    let mut host = Host::with_one();
    assert_eq!(host.ask(1, 3, &[BAUD, 4]), Some((0, vec![])));
    assert_eq!(host.ask(1, 1, &[]), None);
    host.wire.set_baud(115_200);
    assert_eq!(host.ask(1, 1, &[]), Some((0, vec![])));
}

#[test]
fn at_response_level_zero_only_ping_and_read_are_answered() {
    let mut host = Host::with_one();
    host.write(1, RESPONSE_LEVEL, &[0]);
    assert_eq!(host.raw(&frame(1, 3, &[TORQUE, 1])), [0_u8; 0]);
    assert_eq!(host.raw(&frame(1, 4, &[TORQUE, 0])), [0_u8; 0]);
    assert_eq!(host.raw(&frame(1, 5, &[])), [0_u8; 0]);
    assert_eq!(host.ask(1, 1, &[]), Some((0, vec![])));
    assert_eq!(host.read_u8(1, TORQUE), 0);
}

#[test]
fn a_registered_write_waits_for_action() {
    let servos = (1..=2).map(|id| Servo::new(Version::Volts12, 2048.0).with_id(id));
    let mut host = Host::new(servos.collect());
    for id in 1..=2 {
        assert!(host.ask(id, 4, &[GOAL, 0, 4]).is_some());
        assert_eq!(host.read_u16(id, GOAL), 2048);
        assert_eq!(host.read_u8(id, 64), 1);
    }
    assert_eq!(
        host.raw(&frame(0xFE, 5, &[])),
        [0_u8; 0],
        "nobody answers to all"
    );
    for id in 1..=2 {
        assert_eq!(host.read_u16(id, GOAL), 1024);
        assert_eq!(host.read_u8(id, 64), 0);
    }
}

#[test]
fn torque_128_makes_the_present_position_the_centre() {
    let mut host = Host::new(vec![Servo::new(Version::Volts12, 3000.0)]);
    host.write(1, LOCK, &[0]);
    host.write(1, TORQUE, &[128]);
    assert_eq!(host.read_u16(1, POSITION), 2048);
    assert_eq!(host.read_u16(1, OFFSET), 3000 - 2048);
    assert_eq!(host.read_u8(1, TORQUE), 0);
    // Behind the centre the offset is negative, which bit 11 says.
    host.wire
        .bus()
        .servo_mut(0)
        .expect("it is there")
        .turn_to(48.0);
    host.write(1, TORQUE, &[128]);
    assert_eq!(host.read_u16(1, POSITION), 2048);
    assert_eq!(host.read_u16(1, OFFSET), 1 << 11 | 2000);
}

#[test]
fn positions_wrap_at_4096_and_do_not_with_feedback_of_turns() {
    let mut host = Host::new(vec![Servo::new(Version::Volts12, 100.0)]);
    host.write_u16(1, OFFSET, 300);
    assert_eq!(host.read_u16(1, POSITION), 3896);
    let phase = host.read_u8(1, 18);
    host.write(1, 18, &[phase | 1 << 4]);
    assert_eq!(host.read_u16(1, POSITION), 1 << 15 | 200);
}
