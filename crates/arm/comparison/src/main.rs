//! The figures of docs/decisions/servo-driver.md: rustypot and this driver on the same emulated line, with the same faults.
//!
//! A package of its own, outside the workspace: nobody else waits for rustypot to compile.
//! `cargo run --release --manifest-path crates/arm/comparison/Cargo.toml`

mod line;

use std::{collections::BTreeMap, time::Duration};

use line::{Line, Ours, Shared};
use robot_arm::bus::{
    Block, ServoBus,
    register::{PRESENT_POSITION, TORQUE_ENABLE},
};
use robot_servo_model::{Bus, Fault, Servo, Version, VirtualWire};
use rustypot::servo::feetech::sts3215::DEFINITION;

const IDS: [u8; 6] = [1, 2, 3, 4, 5, 6];
const LOOPS: u64 = 1000;
/// The servos stand still: each has a position of its own.
const POSITIONS: [i32; 6] = [1100, 1200, 1300, 1400, 1500, 1600];

/// What a driver made of a line.
#[derive(Debug, Default)]
struct Outcome {
    /// Loops that had all six positions.
    whole: u64,
    /// Loops that ended with an error, and without one position.
    failed: u64,
    /// Loops that had some positions.
    part: u64,
    wrong: u64,
    ms_a_loop: f64,
}

fn line(faults: &[Fault]) -> Shared {
    let servo = |(id, position): (u8, i32)| {
        Servo::new(Version::Volts12, f64::from(position))
            .with_id(id)
            .with_return_delay(0)
    };
    let servos = IDS.into_iter().zip(POSITIONS).map(servo).collect();
    let mut wire = VirtualWire::new(Bus::new(servos, 77));
    wire.wait(100_000_000);
    for fault in faults {
        wire.bus().start(*fault);
    }
    Shared::new(wire)
}

fn count(outcome: &mut Outcome, positions: &[Option<i32>]) {
    let there = positions.iter().flatten().count();
    outcome.whole += u64::from(there == IDS.len());
    outcome.part += u64::from(there < IDS.len());
    let wrong = positions
        .iter()
        .zip(POSITIONS)
        .filter(|(has, wanted)| has.is_some_and(|has| (has - wanted).abs() > 1));
    outcome.wrong += wrong.count() as u64;
}

fn ours(faults: &[Fault]) -> Outcome {
    let shared = line(faults);
    let mut bus = ServoBus::new(Box::new(Ours(shared.clone())), 1_000_000);
    let mut outcome = Outcome::default();
    for _ in 0..LOOPS {
        match bus.sync_read(&IDS, Block::from(PRESENT_POSITION)) {
            Ok(readings) => {
                let value = |r: &Result<robot_arm::bus::BlockReading, _>| {
                    r.as_ref().ok()?.value(PRESENT_POSITION)
                };
                count(
                    &mut outcome,
                    &readings.iter().map(value).collect::<Vec<_>>(),
                );
            }
            Err(_) => outcome.failed += 1,
        }
        bus.broadcast(TORQUE_ENABLE, 0).unwrap();
    }
    outcome.ms_a_loop = shared.ms_since_start() / LOOPS as f64;
    outcome
}

/// With as many tries and the same time-out for an answer.
fn rustypot(faults: &[Fault]) -> Outcome {
    let shared = line(faults);
    let port = Line::new(shared.clone(), Duration::from_millis(20));
    let motors: BTreeMap<u8, _> = IDS.map(|id| (id, DEFINITION)).into();
    let mut bus = rustypot::bus::Bus::new(Box::new(port), motors);
    let mut outcome = Outcome::default();
    for _ in 0..LOOPS {
        match bus.with_retries(5, |bus| bus.sync_read_register(&IDS, "present_position")) {
            Ok(values) => {
                let values: Vec<_> = values.iter().map(|value| Some(*value as i32)).collect();
                count(&mut outcome, &values);
            }
            Err(_) => outcome.failed += 1,
        }
        let _ = bus.sync_write_register(&IDS, "torque_enable", &[0; 6]);
    }
    outcome.ms_a_loop = shared.ms_since_start() / LOOPS as f64;
    outcome
}

fn main() {
    let late = Fault::Delay {
        probability: 0.002,
        by_ns: 30_000_000,
    };
    let lines: [(&str, Vec<Fault>); 5] = [
        ("good line", vec![]),
        (
            "1 % of packets damaged, 0.5 % lost",
            vec![
                Fault::CorruptPacket { probability: 0.01 },
                Fault::DropPacket { probability: 0.005 },
            ],
        ),
        ("one servo gone", vec![Fault::Gone { servo: 3 }]),
        ("0.2 % of bytes 30 ms late", vec![late]),
        ("adapter with echo", vec![Fault::Echo]),
    ];
    for (name, faults) in lines {
        println!(
            "{name}\n  here     {:?}\n  rustypot {:?}",
            ours(&faults),
            rustypot(&faults)
        );
    }
}
