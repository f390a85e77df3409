//! A PC that steers and is lost.

use super::*;

/// Mode PC without a PC is no event; a PC that steered and falls silent is.
#[test]
fn only_a_pc_that_steered_can_be_lost() {
    let mut bench = Bench::new();
    bench.arm();
    bench.report.operator.mode = DriveMode::Pc;
    bench.report.logic.pc_selected = true;
    for flags in [SafetyFlags::PC_LOST, SafetyFlags::PC_AWAITED] {
        bench.report.safety.flags = flags;
        bench.run(SECOND);
    }
    bench.report.safety.flags = SafetyFlags::PC_LOST;
    bench.run(SECOND);
    assert_eq!(bench.event(0), None);
    bench.report.safety.flags = SafetyFlags::NONE;
    bench.run(SECOND);
    bench.report.safety.flags = SafetyFlags::PC_LOST;
    bench.run(SECOND);
    let event = bench.event(0).expect("an event");
    assert_eq!(event.kind, EventKind::PartialStop);
    assert_eq!(event.flags, SafetyFlags::PC_LOST);
}

/// A gap of 105 ms can begin and end between two reports. What remains is that the PC must begin from rest.
#[test]
fn a_loss_of_the_pc_too_short_to_be_seen_counts_too() {
    let mut bench = steered_by_a_pc();
    bench.report.safety.flags = SafetyFlags::PC_AWAITED;
    bench.run(SECOND);
    let event = bench.event(0).expect("an event");
    assert_eq!(event.kind, EventKind::PartialStop);
    assert_eq!(event.flags, SafetyFlags::PC_AWAITED);
}

/// The robot is armed before the PC's program runs.
#[test]
fn a_pc_that_was_missing_when_the_robot_was_armed_can_be_lost_later() {
    for flags in [SafetyFlags::PC_LOST, SafetyFlags::PC_AWAITED] {
        let mut bench = Bench::new();
        bench.report.operator.mode = DriveMode::Pc;
        bench.report.logic.pc_selected = true;
        bench.report.safety.flags = flags;
        bench.arm();
        bench.run(SECOND);
        bench.report.safety.flags = SafetyFlags::NONE;
        bench.run(SECOND);
        assert_eq!(bench.event(0), None);
        bench.report.safety.flags = flags;
        bench.run(SECOND);
        assert_eq!(bench.event(0).expect("an event").flags, flags);
    }
}

#[test]
fn a_pc_that_the_pilot_lets_go_is_not_lost() {
    let mut bench = steered_by_a_pc();
    for selected in [false, true] {
        bench.report.logic.pc_selected = selected;
        bench.report.safety.flags = SafetyFlags::PC_AWAITED;
        bench.run(SECOND);
    }
    assert_eq!(bench.event(0), None);
}

/// The PC must begin from rest after any stop. That is no event of its own.
#[test]
fn what_follows_from_another_stop_is_not_the_pcs() {
    let mut bench = Bench::new();
    bench.report.safety.flags = SafetyFlags::WHEEL_HOT;
    bench.arm();
    bench.report.operator.mode = DriveMode::Pc;
    bench.report.logic.pc_selected = true;
    bench.run(SECOND);
    bench.report.safety.flags = SafetyFlags::PC_AWAITED;
    bench.run(SECOND);
    assert_eq!(bench.event(0), None, "a motor cooled down");
    let mut bench = steered_by_a_pc();
    bench.report.safety.flags = SafetyFlags::COMMAND_STALE.union(SafetyFlags::PC_AWAITED);
    bench.run(SECOND);
    let event = bench.event(0).expect("an event");
    assert_eq!(event.flags, SafetyFlags::COMMAND_STALE);
}

/// A bad cable: the first loss is kept, the gaps after it do not overwrite it.
#[test]
fn a_gap_after_a_loss_is_no_other_event() {
    let mut bench = steered_by_a_pc();
    for flags in [SafetyFlags::PC_LOST, SafetyFlags::PC_AWAITED] {
        bench.report.safety.flags = flags;
        bench.run(SECOND);
        bench.report.safety.flags = SafetyFlags::NONE;
        bench.run(SECOND);
    }
    assert_eq!(bench.states(), [BankState::Event, BankState::Recording]);
}

fn steered_by_a_pc() -> Bench {
    let mut bench = Bench::new();
    bench.arm();
    bench.report.operator.mode = DriveMode::Pc;
    bench.report.logic.pc_selected = true;
    bench.run(SECOND);
    bench
}
