//! What can be read while armed.

use super::*;

/// State 5 is backing off, error 2 a record that read back differently; groups 1 and 4 of the table are unsaved; 300
/// = 0x012C.
#[test]
fn the_store_state_can_be_read_while_armed() {
    let mut bench = Bench::default();
    assert_eq!(bench.read(&[0x31]), [0x31, 0, 0, 0, 0, 0, 0, 0]);
    bench.diagnostics.params = ParamStatus {
        state: ParamState::BackingOff,
        last_error: ParamError::NotProgrammed,
        unsaved: 0b1001,
        save_ok: 300,
        save_failed: 70_000,
        ..ParamStatus::default()
    };
    let expected = [0x31, 5, 2, 2, 0x2C, 0x01, 0xFF, 0xFF];
    assert_eq!(bench.read(&[0x31]), expected);
    assert_eq!(bench.reply(TuningGate::Shut, 0x7A1, &[0x31]), expected);
}

/// Groups 7 and 16 were refused: bits 7 and 16 of the reply.
#[test]
fn the_boot_findings_can_be_read_while_armed() {
    let mut bench = Bench::default();
    assert_eq!(bench.read(&[0x32]), [0x32, 0, 0, 0, 0, 0, 0, 0]);
    bench.diagnostics.params = ParamStatus {
        lost_sectors: 1,
        damaged: 300,
        foreign: 4,
        refused: place(7) | place(16),
        ..ParamStatus::default()
    };
    let expected = [0x32, 1, 255, 4, 0x80, 0x00, 0x01, 0x00];
    assert_eq!(bench.read(&[0x32]), expected);
    assert_eq!(bench.reply(TuningGate::Shut, 0x7A1, &[0x32]), expected);
}

/// Page 7, battery: 24.5 V in steps of 2 mV is 12,250 = 0x2FDA. Page 0x71 does not exist.
#[test]
fn live_pages_can_be_read_while_armed() {
    let mut bench = Bench::default();
    bench.diagnostics.battery_v = 24.5;
    let expected = [0x33, 7, 0xDA, 0x2F, 0, 0, 0, 0];
    assert_eq!(bench.read(&[0x33, 7]), expected);
    assert_eq!(bench.reply(TuningGate::Shut, 0x7A1, &[0x33, 7]), expected);
    assert_eq!(bench.read(&[0x33, 0x71]), [0xEE, 0x33, 3, 0x71, 0, 0, 0, 0]);
    assert_eq!(bench.read(&[0x33]), [0xEE, 0x33, 1, 0, 0, 0, 0, 0]);
    assert_eq!(
        bench.write(&[0x33, 7, 0, 0, 0, 0, 0, 0])[..3],
        [0xEE, 0x33, 2]
    );
    assert!(bench.unchanged());
}

/// The store reads the settings only now and then. A change it has not seen yet must not count as saved.
#[test]
fn a_change_counts_as_unsaved_from_its_reply_on() {
    let mut bench = tuned();
    assert_eq!(bench.read(&[0x31])[..4], [0x31, 1, 0, 1]);
    bench.diagnostics.params.seen = 2;
    bench.diagnostics.params.unsaved = 0b10;
    bench.diagnostics.params.state = ParamState::Saving;
    assert_eq!(bench.read(&[0x31])[..4], [0x31, 3, 0, 1]);
    bench.write(&[0x20, 7, 0, 0, 0x00, 0x00, 0x00, 0x42]);
    assert_eq!(bench.read(&[0x31])[..4], [0x31, 1, 0, 2]);
}
