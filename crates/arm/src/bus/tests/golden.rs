//! Bytes on the line, from the format in the manufacturer's SDK and from sums made by hand.

use super::script::{ScriptWire, answer, soon};
use crate::bus::{Block, ServoBus, register::*};

fn hex(text: &str) -> Vec<u8> {
    text.split(' ')
        .map(|byte| u8::from_str_radix(byte, 16).unwrap())
        .collect()
}

/// What the first request of `act` is.
fn sent(act: impl FnOnce(&mut ServoBus)) -> Vec<u8> {
    let (mut bus, sent) = ScriptWire::bus(|_| vec![]);
    act(&mut bus);
    let sent = sent.lock().unwrap();
    sent.first().cloned().unwrap_or_default()
}

#[test]
fn requests_are_the_bytes_of_the_manufacturers_format() {
    let first = sent(|bus| drop(bus.ping(1)));
    assert_eq!(first, hex("FF FF 01 02 01 FB"));
    let first = sent(|bus| drop(bus.read(1, PRESENT_POSITION)));
    assert_eq!(first, hex("FF FF 01 04 02 38 02 BE"));
    let first = sent(|bus| drop(bus.write(1, TORQUE_ENABLE, 1)));
    assert_eq!(first, hex("FF FF 01 04 03 28 01 CE"));
    let goal = [
        (ACCELERATION, 50),
        (GOAL_POSITION, 2048),
        (GOAL_TIME, 0),
        (GOAL_SPEED, 1000),
    ];
    let first = sent(|bus| drop(bus.write_block(1, &goal)));
    assert_eq!(first, hex("FF FF 01 0A 03 29 32 00 08 00 00 E8 03 A3"));
    let first =
        sent(|bus| drop(bus.sync_read(&[1, 2], Block::new(PRESENT_POSITION, PRESENT_TEMPERATURE))));
    assert_eq!(first, hex("FF FF FE 06 82 38 08 01 02 36"));
    let (one, two) = ([(GOAL_POSITION, 2048)], [(GOAL_POSITION, 1024)]);
    let first = sent(|bus| drop(bus.sync_write(&[(1, &one), (2, &two)])));
    assert_eq!(first, hex("FF FF FE 0A 83 2A 02 01 00 08 02 00 04 39"));
}

/// 0x01 + 0x0A + 0x04 + … = 0x17B for the first, whose complement ends in 0x84; 0xFE + 0x02 + 0x05 = 0x105, then 0xFA; 0xFE + 4 +
/// 3 + 0x28 + 0 = 0x12D, then 0xD2.
#[test]
fn prepared_writes_action_and_broadcast_have_their_instructions() {
    let first = sent(|bus| drop(bus.reg_write(1, &[(GOAL_POSITION, 2048)])));
    assert_eq!(first, hex("FF FF 01 05 04 2A 00 08 C3"));
    assert_eq!(sent(|bus| bus.action().unwrap()), hex("FF FF FE 02 05 FA"));
    let first = sent(|bus| bus.broadcast(TORQUE_ENABLE, 0).unwrap());
    assert_eq!(first, hex("FF FF FE 04 03 28 00 D2"));
}

#[test]
fn values_and_alarms_are_those_of_the_answer() {
    // −100 has its sign in bit 15, a load of −250 in bit 10.
    let data = [0x64, 0x80, 0x00, 0x00, 0xFA, 0x04, 0x7A, 0x23];
    let (mut bus, _) = ScriptWire::bus(move |_| soon(answer(3, 0x20, &data)));
    let block = Block::new(PRESENT_POSITION, PRESENT_TEMPERATURE);
    let reading = bus.read_block(3, block).unwrap();
    assert_eq!(reading.value(PRESENT_POSITION), Some(-100));
    assert_eq!(reading.value(PRESENT_SPEED), Some(0));
    assert_eq!(reading.value(PRESENT_LOAD), Some(-250));
    assert_eq!(reading.value(PRESENT_VOLTAGE), Some(122));
    assert_eq!(reading.value(PRESENT_TEMPERATURE), Some(35));
    assert_eq!(reading.value(GOAL_POSITION), None);
    assert_eq!(reading.value(STATUS), None);
    assert_eq!(reading.alarms.to_string(), "overload");
}
