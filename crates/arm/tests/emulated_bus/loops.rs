//! Control loops on a bad line.

use std::time::Duration;

use robot_arm::bus::{
    Block,
    register::{
        GOAL_POSITION, MAX_POSITION, MIN_POSITION, PRESENT_POSITION, Register, TORQUE_ENABLE,
    },
};
use robot_servo_model::Fault;

use crate::wire::Emulated;

const IDS: [u8; 6] = [1, 2, 3, 4, 5, 6];
/// A position is that of a moment between the looks before and after it, and the servo looks at its sensor now and then.
const NEAR: i32 = 3;

#[derive(Debug, Default)]
struct Outcome {
    loops: u64,
    aborted: u64,
    wrong: u64,
    missing: u64,
    sim_seconds: f64,
}

/// Reads and writes six servos for so many loops. Each value is compared with the emulated servo's own.
fn run(emulated: &Emulated, loops: u64) -> Outcome {
    let mut bus = emulated.bus();
    let mut outcome = Outcome::default();
    let started = bus.now();
    for number in 0..loops {
        outcome.loops += 1;
        let before = emulated.view();
        let readings = match bus.sync_read(&IDS, Block::from(PRESENT_POSITION)) {
            Ok(readings) => readings,
            Err(_) => {
                outcome.aborted += 1;
                continue;
            }
        };
        let looks = before.iter().zip(emulated.view());
        for (reading, (before, after)) in readings.iter().zip(looks) {
            match reading {
                Ok(reading) => {
                    let steps = reading.value(PRESENT_POSITION).unwrap();
                    let (one, other) = (before.position_steps, after.position_steps);
                    let possible = one.min(other) - NEAR..=one.max(other) + NEAR;
                    outcome.wrong += u64::from(!possible.contains(&steps));
                }
                Err(_) => outcome.missing += 1,
            }
        }
        let goals = IDS.map(|id| (id, [(GOAL_POSITION, goal(id, number))]));
        let goals: Vec<(u8, &[(Register, i32)])> =
            goals.iter().map(|(id, goal)| (*id, &goal[..])).collect();
        outcome.aborted += u64::from(bus.sync_write(&goals).is_err());
        // A register that does not change is compared to the step.
        let id = IDS[number as usize % 6];
        match bus.read_block(id, Block::new(MIN_POSITION, MAX_POSITION)) {
            Ok(limits) => {
                let limits = (limits.value(MIN_POSITION), limits.value(MAX_POSITION));
                outcome.wrong += u64::from(limits != (Some(0), Some(4095)));
            }
            Err(_) => outcome.missing += 1,
        }
    }
    outcome.sim_seconds = (bus.now() - started).as_secs_f64();
    println!("{outcome:?} {:?}", bus.statistics());
    outcome
}

/// Where a loop of this number sends a servo.
fn goal(id: u8, number: u64) -> i32 {
    let angle = number as f64 * 0.002 + f64::from(id);
    (2000.0 + 300.0 * angle.sin()) as i32
}

/// Sends all servos to where the loops begin.
fn start(emulated: &Emulated) {
    let mut bus = emulated.bus();
    for id in IDS {
        bus.write(id, GOAL_POSITION, goal(id, 0)).unwrap();
        bus.write(id, TORQUE_ENABLE, 1).unwrap();
    }
    bus.wait(Duration::from_secs(2)).unwrap();
}

/// `ROBOT_ARM_LOOPS` sets how many; 1,300,000 take an hour on the line.
#[test]
fn one_percent_corrupted_and_half_a_percent_lost_abort_no_loop_and_bring_no_wrong_value() {
    let loops = std::env::var("ROBOT_ARM_LOOPS")
        .ok()
        .and_then(|n| n.parse().ok());
    let loops = loops.unwrap_or(4000);
    let emulated = Emulated::arm(20);
    start(&emulated);
    emulated
        .wire()
        .bus()
        .start(Fault::CorruptPacket { probability: 0.01 });
    emulated
        .wire()
        .bus()
        .start(Fault::DropPacket { probability: 0.005 });
    let outcome = run(&emulated, loops);
    let injected = emulated.wire().bus().injected();
    println!("{injected:?}");
    assert!(injected.corrupted_packets > loops / 20, "{injected:?}");
    assert_eq!(
        (outcome.aborted, outcome.wrong, outcome.missing),
        (0, 0, 0),
        "{outcome:?}"
    );
}

/// Bytes that come 30 ms late: after the time-out, among the answers of later questions.
#[test]
fn late_bytes_bring_no_wrong_value() {
    let emulated = Emulated::arm(21);
    start(&emulated);
    let by_ns = Duration::from_millis(30).as_nanos() as u64;
    emulated.wire().bus().start(Fault::Delay {
        probability: 0.001,
        by_ns,
    });
    let outcome = run(&emulated, 1500);
    assert!(emulated.wire().bus().injected().delayed_bytes > 50);
    assert_eq!((outcome.aborted, outcome.wrong), (0, 0), "{outcome:?}");
}

#[test]
fn an_adapter_with_echo_is_as_good_as_one_without() {
    let emulated = Emulated::arm(22);
    start(&emulated);
    emulated.wire().bus().start(Fault::Echo);
    emulated
        .wire()
        .bus()
        .start(Fault::CorruptPacket { probability: 0.01 });
    let outcome = run(&emulated, 1000);
    assert_eq!(
        (outcome.aborted, outcome.wrong, outcome.missing),
        (0, 0, 0),
        "{outcome:?}"
    );
}

/// The line alone allows more than 500 loops a second.
#[test]
fn a_loop_of_six_servos_takes_less_than_two_milliseconds_of_line() {
    let emulated = Emulated::arm(23);
    let mut bus = emulated.bus();
    let started = bus.now();
    for number in 0..100 {
        bus.sync_read(&IDS, PRESENT_POSITION.into()).unwrap();
        let goals = IDS.map(|id| (id, [(GOAL_POSITION, 2000 + number)]));
        let goals: Vec<(u8, &[(Register, i32)])> =
            goals.iter().map(|(id, goal)| (*id, &goal[..])).collect();
        bus.sync_write(&goals).unwrap();
    }
    // 14 + 6 × 8 bytes and 26 bytes at 10 µs.
    let each = (bus.now() - started) / 100;
    assert!(each < Duration::from_micros(2000), "{each:?}");
    println!("{each:?} a loop");
}
