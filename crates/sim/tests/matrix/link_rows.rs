//! Expected outcome of the faults of the serial link and of the PC on it (docs/safety.md, docs/pc-link.md), and of others
//! while a PC drives.

use robot_plant::time::MS;

use crate::{
    balancing_expected::Outcome,
    driver::Driver,
    expected::{NEXT_FRAME_MS, REMOTE_LOST_MS},
    row::{After, Arms, Flags, Group, Moves, Row, flags, global, harmless, row},
};

/// A command is at most 100 ms old, from the end of its last byte on, which came before the fault; then 3 ms to zero on
/// both buses.
const PC_LOST_MS: f64 = 100.0 + 3.0;
/// The age limit of a PC that repeats itself, a frame's length, and 3 ms to zero.
const PC_FROZEN_MS: f64 = 5_000.0 + 1.0 + 3.0;

pub fn rows() -> Vec<Row> {
    let mut rows = Vec::new();
    for fault in ["link-cut", "link-cut-down", "link-flood", "link-break"] {
        rows.push(manual(fault));
        rows.push(lost(fault, PC_LOST_MS));
    }
    rows.push(manual("link-cut-up"));
    // The PC does not hear the robot, but the robot hears the PC.
    rows.push(steered(harmless("link-cut-up", Flags::default())));
    rows.push(manual("link-noise"));
    rows.push(noisy("link-noise"));
    rows.push(lasting(manual("pc-frozen")));
    rows.push(lasting(frozen("pc-frozen")));
    rows.push(manual("pc-extremes"));
    rows.push(extremes("pc-extremes"));
    rows.extend(faults_of_others());
    rows
}

/// While the pilot drives, nothing that the PC or its cable does matters.
fn manual(fault: &'static str) -> Row {
    harmless(fault, Flags::default()).driven_by(Driver::PilotBesidePc)
}

/// A PC drives. It asks for motion all the time, so that a robot that is armed meanwhile waits. It awaits a PC from before
/// the fault on, unless it drives.
fn steered(row: Row) -> Row {
    let mut row = row.driven_by(Driver::Pc);
    row.disarmed.moves = Moves::Never;
    for flags in [
        &mut row.driving.flags,
        &mut row.idle.flags,
        &mut row.disarmed.flags,
        &mut row.balancing.flags,
    ] {
        flags.may.push("pc-awaited");
    }
    row
}

/// No command comes through: all stops, and afterwards waits until the PC starts from rest. It does not keep the pilot
/// from arming.
fn lost(fault: &'static str, within_ms: f64) -> Row {
    let zero = Group::Zero(within_ms);
    let lost = flags(&["pc-lost"], &[]);
    let mut row = steered(row(fault, zero, zero, lost.clone(), After::PcWaits));
    // The pilot's command to stand remains.
    row.balancing.outcome = Outcome::OnTheSpot;
    row.balancing.flags = lost;
    row.balancing.flags.may.push("pc-awaited");
    row.arms_during(Arms::Yes)
}

/// Damaged frames may add up to a loss; a damaged frame is never obeyed.
fn noisy(fault: &'static str) -> Row {
    let mut row = steered(row(
        fault,
        Group::Either,
        Group::Either,
        flags(&[], &["pc-lost"]),
        After::WhatRan,
    ));
    row.keeps_law = true;
    row.balancing.outcome = Outcome::Balances;
    row.balancing.flags = flags(&[], &["pc-lost", "pc-awaited"]);
    row.arms_during(Arms::Yes)
}

/// Only a PC that asks the wheels to turn has to show that it is alive.
fn frozen(fault: &'static str) -> Row {
    let lost = lost(fault, PC_FROZEN_MS);
    let disarmed = lost.disarmed.clone();
    Row {
        disarmed,
        ..lost.unseen_at_rest()
    }
}

fn lasting(mut row: Row) -> Row {
    row.lasts = 6_000 * MS;
    row
}

/// The setting of 5 N·m holds at the angle and speed of the joint's last report. From there to the command the joint goes on
/// for 1 ms with the torque of the command before, which may be the opposite extreme: 5 N·m, gravity and friction of
/// 1.15 N·m on the leg's 0.02 kg·m² change its speed by 0.31 rad/s, 1.54 N·m at the largest Kd of 5. In the 2 ms to the next
/// command gravity and friction change it by 0.115 rad/s more, 0.58 N·m. In all 3 ms it moves 1.1 mrad, 0.56 N·m at the
/// largest Kp of 500. The motor itself gives 7 N·m at most.
const EXTREME_GAINS_NM: f64 = 5.0 + 1.54 + 0.58 + 0.56;

/// Every frame is a valid command, and some of them ask for rest.
fn extremes(fault: &'static str) -> Row {
    let mut row = steered(harmless(fault, Flags::default()));
    row.disarmed.moves = Moves::AsArmed;
    row.most_torque_nm = EXTREME_GAINS_NM;
    // A pilot, too, could make it jump while it turns and rolls at its limits.
    row.balancing.may_fall();
    row
}

/// The pilot's switches and the robot's own stops come before the PC.
fn faults_of_others() -> Vec<Row> {
    let lost = flags(&["remote-lost"], &["remote-quality", "remote-failsafe"]);
    let zero = Group::Zero(600.0);
    // A motor that has cooled down continues only with a PC that starts from rest, and so do the joints. A PC that holds the
    // robot still is at rest.
    let mut hot = row(
        "motor-0-hot",
        zero,
        Group::Runs,
        flags(&["wheel-hot"], &[]),
        After::PcWaits,
    );
    hot.idle.after = After::Drives;
    vec![
        steered(global("e-stop", NEXT_FRAME_MS, flags(&["e-stop"], &[]))),
        steered(global("sbus-silent", REMOTE_LOST_MS, lost)),
        steered(hot),
    ]
}
