//! The black box over the channel.

use super::*;
use crate::{
    domain::{BankState, BankStatus, EventKind},
    safety::ArmingState,
};

/// Bank 1 holds event 0x0203; bank 0 records.
fn bench() -> Bench {
    let mut bench = Bench::default();
    bench.diagnostics.black_box.overwritten = 300;
    bench.diagnostics.black_box.banks = [
        BankStatus {
            state: BankState::Recording,
            number: 0x0204,
            kind: EventKind::None,
        },
        BankStatus {
            state: BankState::Event,
            number: 0x0203,
            kind: EventKind::PartialStop,
        },
    ];
    bench
}

/// 56 · 256 bytes = 14,336; layout 2.
#[test]
fn a_bank_says_what_it_holds_at_any_time() {
    let mut bench = bench();
    for state in [ArmingState::Disarmed, ArmingState::Armed] {
        bench.diagnostics.arming.state = state;
        assert_eq!(bench.read(&[0x44, 0]), [0x44, 0, 1, 4, 2, 56, 2, 255]);
        assert_eq!(bench.read(&[0x44, 1]), [0x44, 1, 0x23, 3, 2, 56, 2, 255]);
    }
    assert_eq!(bench.read(&[0x44, 2]), [0xEE, 0x44, 3, 0, 0, 0, 0, 0]);
    assert_eq!(bench.read(&[0x44]), [0xEE, 0x44, 1, 0, 0, 0, 0, 0]);
}

#[test]
fn only_the_event_of_a_disarmed_robot_is_read_and_released() {
    let mut bench = bench();
    let read = [0x45, 1, 0x00, 0x01, 3];
    let release = [0x46, 1, 3, 2, 0, 0, 0, 0];
    bench.diagnostics.arming.state = ArmingState::Armed;
    assert_eq!(bench.read(&read), [0xEE, 0x45, 5, 0, 0, 0, 0, 0]);
    assert_eq!(bench.write(&release), [0xEE, 0x46, 5, 0, 0, 0, 0, 0]);
    bench.diagnostics.arming.state = ArmingState::Disarmed;
    let other = [0x45, 0, 0, 0, 3];
    assert_eq!(bench.read(&other), [0xEE, 0x45, 4, 0, 0, 0, 0, 0]);
    let other = [0x46, 1, 4, 2, 0, 0, 0, 0];
    assert_eq!(bench.write(&other), [0xEE, 0x46, 4, 0, 0, 0, 0, 0]);
    assert!(!bench.channel.block().is_running());
    assert_eq!(bench.channel.status().black_box_released, [0; 2]);
    // The enable switch may be on.
    let reply = bench.reply(TuningGate::Shut, 0x7A1, &read);
    assert_eq!(reply, [0x45, 1, 0x00, 0x01, 3, 0, 0, 0]);
    assert!(bench.channel.block().is_running());
    assert_eq!(bench.reply(TuningGate::Shut, 0x7A0, &release), release);
    assert_eq!(bench.channel.status().black_box_released, [0, 0x0203]);
    assert!(bench.unchanged());
}

/// Both would come in the same ticks.
#[test]
fn a_block_is_refused_while_the_sensors_are_recorded() {
    let mut bench = bench();
    let read = [0x45, 1, 0, 0, 3];
    let record = |seconds| [0x42, seconds, 0, 0, 0, 0, 0, 0];
    bench.write(&record(60));
    assert_eq!(bench.read(&read), [0xEE, 0x45, 11, 0, 0, 0, 0, 0]);
    assert!(!bench.channel.block().is_running());
    bench.write(&record(0));
    assert_eq!(bench.read(&read), [0x45, 1, 0, 0, 3, 0, 0, 0]);
    assert!(bench.channel.block().is_running());
}
