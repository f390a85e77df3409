//! Answers that come too late, twice, or from somebody else.

use std::time::Duration;

use super::script::{ScriptWire, answer, soon};
use crate::bus::{Block, BusError, Cause, register::*};

fn ms(time: u64) -> Duration {
    Duration::from_millis(time)
}

/// Number of bytes that a read asks for.
fn asked_bytes(request: &[u8]) -> usize {
    request[6].into()
}

/// A position, and what else was asked for.
fn position(request: &[u8], position: u16) -> Vec<u8> {
    let mut data = position.to_le_bytes().to_vec();
    data.resize(asked_bytes(request), 0);
    answer(1, 0, &data)
}

/// The first answer comes 24 ms after its request: too late, after the second try has begun, and before the second answer. Both have the servo's id and a right checksum.
#[test]
fn a_late_answer_is_not_taken_for_the_next() {
    let mut number = 0;
    let (mut bus, _) = ScriptWire::bus(move |request| {
        number += 1;
        match number {
            1 => vec![(ms(24), position(request, 111))],
            _ => vec![(ms(3), position(request, 222))],
        }
    });
    let reading = bus.read(1, PRESENT_POSITION).unwrap();
    assert_eq!(reading.value, 222);
    assert_eq!(bus.statistics().other_length, 1, "{:?}", bus.statistics());
}

/// Each answer comes when the question after it has been asked. None of them is taken, whatever the question.
#[test]
fn answers_that_are_always_one_question_late_are_never_taken() {
    let mut last: Option<Vec<u8>> = None;
    let mut value = 0u16;
    let (mut bus, _) = ScriptWire::bus(move |request| {
        value += 1;
        let due = last.replace(position(request, value));
        due.into_iter().map(|late| (ms(1), late)).collect()
    });
    for _ in 0..40 {
        let error = bus.read(1, PRESENT_POSITION).unwrap_err();
        assert!(matches!(error, BusError::Servo(_)), "{error}");
    }
}

/// The acknowledgement of a first write comes in the middle of the second, which was lost.
#[test]
fn a_late_acknowledgement_confirms_no_other_write() {
    let mut number = 0;
    let (mut bus, sent) = ScriptWire::bus(move |request| {
        number += 1;
        match (number, request[4]) {
            (1, 3) => vec![(ms(24), answer(1, 0, &[]))],
            // A servo answers in order: this comes after the late one.
            (_, 2) => vec![(ms(6), answer(1, 0, &vec![1; asked_bytes(request)]))],
            // The second write does not reach the servo; the third does.
            (3, 3) => vec![],
            _ => soon(answer(1, 0, &[])),
        }
    });
    bus.write(1, TORQUE_ENABLE, 1).unwrap();
    let writes = sent.lock().unwrap().iter().filter(|r| r[4] == 3).count();
    assert_eq!(writes, 3);
}

#[test]
fn five_good_answers_and_one_error_are_usable() {
    let (mut bus, _) = ScriptWire::bus(move |request| {
        let ids = &request[7..request.len() - 1];
        let good = ids.iter().filter(|id| **id != 4);
        let size = asked_bytes(request);
        soon(
            good.flat_map(|id| answer(*id, 0, &vec![*id; size]))
                .collect(),
        )
    });
    bus.name(4, "wrist_flex");
    let readings = bus
        .sync_read(&[1, 2, 3, 4, 5, 6], Block::from(PRESENT_VOLTAGE))
        .unwrap();
    for (place, reading) in readings.iter().enumerate().filter(|(place, _)| *place != 3) {
        let value = reading.as_ref().unwrap().value(PRESENT_VOLTAGE);
        assert_eq!(value, Some(place as i32 + 1));
    }
    let error = readings[3].as_ref().unwrap_err();
    assert_eq!((error.cause, error.tries), (Cause::NoAnswer, 6));
    let said = error.to_string();
    assert!(
        said.starts_with("servo 4 (wrist_flex), read present_voltage, asked 6 times: no answer."),
        "{said}"
    );
    // The next time it is asked once, so that the loop does not become slow.
    let readings = bus
        .sync_read(&[1, 2, 3, 4, 5, 6], Block::from(PRESENT_VOLTAGE))
        .unwrap();
    assert_eq!(readings[3].as_ref().unwrap_err().tries, 1);
}

#[test]
fn a_servo_in_place_of_another_is_named() {
    let (mut bus, _) = ScriptWire::bus(|_| soon(answer(5, 0, &[7])));
    let Err(BusError::Servo(error)) = bus.read(1, ID) else {
        panic!("no answer of servo 1");
    };
    assert_eq!(error.cause, Cause::OtherServo { id: 5 });
    assert_eq!(bus.statistics().alien, 6);
}

#[test]
fn the_adapters_echo_is_no_answer() {
    // Read as an answer, the request for two bytes at 56 would be a position of 568 with an alarm.
    let (mut bus, _) = ScriptWire::bus(|request| soon(request.to_vec()));
    assert!(bus.read(1, PRESENT_POSITION).is_err());
    let (mut bus, _) =
        ScriptWire::bus(|request| soon([request.to_vec(), position(request, 2047)].concat()));
    assert_eq!(bus.read(1, PRESENT_POSITION).unwrap().value, 2047);
    assert_eq!(bus.statistics().echoes, 1);
}

/// Its answer to a ping is a copy of the ping: status 1 in place of instruction 1.
#[test]
fn a_servo_with_a_voltage_alarm_answers_a_ping_although_it_looks_like_an_echo() {
    let servo = |request: &[u8]| match request[4] {
        1 => soon(answer(1, 1, &[])),
        _ => soon(answer(1, 1, &vec![1; asked_bytes(request)])),
    };
    let (mut bus, _) = ScriptWire::bus(servo);
    let alarms = bus.ping(1).unwrap();
    assert_eq!(alarms.to_string(), "input voltage out of range");
    // With an adapter that returns what is sent, and nobody there, the ping fails.
    let (mut bus, _) = ScriptWire::bus(|request| soon(request.to_vec()));
    assert!(bus.ping(1).is_err());
}

#[test]
fn a_device_that_never_stops_sending_ends_nothing() {
    let (mut bus, _) = ScriptWire::bus(|_| {
        (0..10_000)
            .map(|at| (Duration::from_micros(50 * at), vec![0xFF, 0xFF, 0x01, 0x04]))
            .collect()
    });
    assert!(bus.read(1, PRESENT_POSITION).is_err());
}
