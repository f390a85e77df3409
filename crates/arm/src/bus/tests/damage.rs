//! Damaged, short and surrounded answers.

use proptest::prelude::*;

use super::script::{ScriptWire, answer, soon};
use crate::bus::{BusError, Cause, register::*};

#[test]
fn an_answer_in_noise_is_found() {
    let noise = [0x00, 0xFF, 0x37, 0xFF, 0xFF, 0xFF];
    let (mut bus, _) =
        ScriptWire::bus(move |_| soon([&noise, &answer(1, 0, &[0, 8])[2..], &[9]].concat()));
    assert_eq!(bus.read(1, PRESENT_POSITION).unwrap().value, 2048);
}

#[test]
fn a_header_with_a_damaged_length_does_not_swallow_the_answer_behind_it() {
    // The first answer's length is 0x06 instead of 0x04, so that it would end in the second.
    let mut first = answer(1, 0, &[1, 1]);
    first[3] = 6;
    let second = answer(2, 0, &[2, 2]);
    let mut number = 0;
    let (mut bus, _) = ScriptWire::bus(move |request| {
        number += 1;
        match number {
            1 => soon([first.clone(), second.clone()].concat()),
            _ => soon(answer(1, 0, &vec![1; request[6].into()])),
        }
    });
    let readings = bus.sync_read(&[1, 2], PRESENT_POSITION.into()).unwrap();
    assert_eq!(
        readings[1].as_ref().unwrap().value(PRESENT_POSITION),
        Some(0x0202)
    );
    assert_eq!(
        readings[0].as_ref().unwrap().value(PRESENT_POSITION),
        Some(0x0101)
    );
    assert_eq!(
        bus.statistics().sent,
        2,
        "only the first servo is asked again"
    );
}

#[test]
fn two_servos_with_one_id_are_named_as_the_likely_cause() {
    let mut both = answer(1, 0, &[0x12, 0x08]);
    both[5] |= 0x21;
    let (mut bus, _) = ScriptWire::bus(move |_| soon(both.clone()));
    let Err(BusError::Servo(error)) = bus.read(1, PRESENT_POSITION) else {
        panic!("an answer was taken");
    };
    assert_eq!(error.cause, Cause::Damaged);
    assert!(
        error.to_string().contains("Two servos with one id"),
        "{error}"
    );
}

proptest! {
    /// Whatever one byte of an answer becomes, or if it is lost or doubled: the value is right, or there is none.
    #[test]
    fn one_wrong_byte_brings_no_wrong_value(
        value in 0u16..4096, place in 0usize..8, other in any::<u8>(), kind in 0..3,
    ) {
        let good = answer(1, 0, &value.to_le_bytes());
        let mut bad = good.clone();
        match kind {
            0 => bad[place] = other,
            1 => { bad.remove(place); }
            _ => bad.insert(place, other),
        }
        let mut number = 0;
        let (mut bus, _) = ScriptWire::bus(move |request| {
            number += 1;
            let mut data = value.to_le_bytes().to_vec();
            data.resize(request[6].into(), 0);
            match number {
                1 => soon(bad.clone()),
                _ => soon(answer(1, 0, &data)),
            }
        });
        prop_assert_eq!(bus.read(1, PRESENT_POSITION).unwrap().value, i32::from(value));
    }
}

#[test]
fn status_bits_that_no_servo_has_are_damage() {
    let (mut bus, _) = ScriptWire::bus(|_| soon(answer(1, 0x80, &[0, 8])));
    assert!(bus.read(1, PRESENT_POSITION).is_err());
    assert_eq!(bus.statistics().damaged, 6);
}
