//! Writes, and what is stored.

use std::sync::{Arc, Mutex};

use super::script::{ScriptWire, answer, soon};
use crate::bus::{BusError, Cause, ServoBus, register::*};

type Memory = Arc<Mutex<[u8; 96]>>;

/// A servo with a memory, an id in it, and a lock. `answers_writes` is its response level.
fn servo(answers_writes: bool) -> (ServoBus, Memory) {
    let memory = Memory::new(Mutex::new([0; 96]));
    memory.lock().unwrap()[5] = 1;
    memory.lock().unwrap()[8] = answers_writes.into();
    let shared = memory.clone();
    let (bus, _) = ScriptWire::bus(move |request| {
        let mut memory = shared.lock().unwrap();
        let (id, parameters) = (memory[5], &request[5..request.len() - 1]);
        if request[2] != id {
            return vec![];
        }
        match request[4] {
            1 => soon(answer(id, 0, &[])),
            2 => {
                let (from, size) = (usize::from(parameters[0]), usize::from(parameters[1]));
                soon(answer(id, 0, &memory[from..from + size]))
            }
            3 => {
                let from = usize::from(parameters[0]);
                memory[from..from + parameters.len() - 1].copy_from_slice(&parameters[1..]);
                if answers_writes {
                    soon(answer(id, 0, &[]))
                } else {
                    vec![]
                }
            }
            _ => vec![],
        }
    });
    (bus, memory)
}

#[test]
fn a_stored_value_is_looked_at_and_locked_and_the_torque_is_off() {
    let (mut bus, memory) = servo(true);
    memory.lock().unwrap()[40] = 1;
    bus.store(1, &[(HOMING_OFFSET, -1000), (RETURN_DELAY, 0)])
        .unwrap();
    let memory = memory.lock().unwrap();
    assert_eq!(memory[31..33], [0xE8, 0x0B]);
    assert_eq!((memory[40], memory[55]), (0, 1));
}

#[test]
fn what_is_stored_already_is_not_written() {
    let (mut bus, memory) = servo(true);
    memory.lock().unwrap()[40] = 1;
    bus.store(1, &[(HOMING_OFFSET, 0)]).unwrap();
    assert_eq!(memory.lock().unwrap()[40], 1, "torque stays on");
}

#[test]
fn a_servo_that_answers_reads_only_is_written_and_looked_at() {
    let (mut bus, memory) = servo(false);
    bus.write(1, GOAL_POSITION, 1234).unwrap();
    assert_eq!(memory.lock().unwrap()[42..44], 1234u16.to_le_bytes());
    let sent = bus.statistics().sent;
    bus.write(1, GOAL_POSITION, 1235).unwrap();
    assert_eq!(bus.statistics().sent - sent, 2, "the write and a look");
}

#[test]
fn an_id_is_changed_and_locked() {
    let (mut bus, memory) = servo(true);
    bus.change_id(1, 6).unwrap();
    let memory = memory.lock().unwrap();
    assert_eq!((memory[5], memory[55], memory[40]), (6, 1, 0));
}

#[test]
fn values_that_do_not_fit_are_not_sent() {
    let (mut bus, sent) = ScriptWire::bus(|_| vec![]);
    let said = bus.write(1, HOMING_OFFSET, 2048).unwrap_err().to_string();
    assert_eq!(
        said,
        "homing_offset = 2048: a servo's homing_offset takes -2047 to 2047"
    );
    assert!(bus.write(1, TORQUE_ENABLE, -1).is_err());
    assert!(matches!(
        bus.write(1, PRESENT_POSITION, 0),
        Err(BusError::ReadOnly { .. })
    ));
    assert!(matches!(
        bus.write(254, TORQUE_ENABLE, 0),
        Err(BusError::Id { id: 254 })
    ));
    let apart = [(GOAL_POSITION, 0), (GOAL_SPEED, 0)];
    assert!(matches!(
        bus.write_block(1, &apart),
        Err(BusError::NotNeighbours { .. })
    ));
    assert!(matches!(bus.write_block(1, &[]), Err(BusError::Nothing)));
    let ids: Vec<u8> = (0..=253).collect();
    assert!(matches!(
        bus.sync_read(&ids, ID.into()),
        Err(BusError::TooLong)
    ));
    assert!(sent.lock().unwrap().is_empty());
}

#[test]
fn a_value_that_the_servo_does_not_keep_is_an_error() {
    let (mut bus, _) = ScriptWire::bus(|request| match request[4] {
        2 => soon(answer(1, 0, &vec![0; request[6].into()])),
        _ => soon(answer(1, 0, &[])),
    });
    let Err(BusError::Servo(error)) = bus.store(1, &[(MAX_POSITION, 3000)]) else {
        panic!("stored");
    };
    assert_eq!(
        error.cause,
        Cause::NotKept {
            wanted: 3000,
            has: 0
        }
    );
}
