//! Compares the observations with the expected reactions.

use robot_plant::time::{MS, Ps};

use crate::{
    balancing_judge,
    driver::Driver,
    observed::{Observed, Phase, Wire},
    row::{After, Armed, Arms, Disarmed, Flags, Group, Moves, Row},
};

/// The span before an instant that shows the state at that instant.
const STATE_WINDOW: Ps = 200 * MS;
const MOST_CURRENT_MA: f64 = 8_000.0;
const MOST_BALANCING_MA: f64 = 15_000.0;

/// Differences from the expectation, as text.
pub fn violations(row: &Row, phase: Phase, seen: &Observed) -> Vec<String> {
    let mut all = match phase {
        Phase::Balancing => balancing_judge::violations(row, seen),
        Phase::Driving => armed(&row.driving, seen, true),
        Phase::Idle => armed(&row.idle, seen, false),
        Phase::Disarmed => disarmed(&row.disarmed, seen),
    };
    if let Some(at) = seen.torque_unarmed.first() {
        let at = *at as f64 / MS as f64;
        all.push(format!(
            "torque left the board unarmed at {at:.1} ms of the run"
        ));
    }
    all.extend(seen.wrong_torques.first().cloned());
    all.extend(beyond_limits(row, phase, seen));
    let resets = usize::from(row.resets);
    if seen.resets != resets {
        all.push(format!("{} resets instead of {resets}", seen.resets));
    }
    let is_expected = |error: &&String| !row.board_errors.iter().any(|part| error.contains(part));
    let errors = seen.board_errors.iter().filter(is_expected);
    all.extend(errors.map(|error| format!("board error: {error}")));
    all
}

/// A command beyond the limits: for a wheel 8 A by the settings, and 15 A by the robot's file while it balances; for a joint
/// what its row says.
fn beyond_limits(row: &Row, phase: Phase, seen: &Observed) -> Option<String> {
    let most = |wires: &[Wire]| {
        let values = wires.iter().flat_map(|wire| &wire.changes);
        values.map(|(_, value)| value.abs()).fold(0.0, f64::max)
    };
    let (current_ma, torque_nm) = (most(&seen.wheels), most(&seen.joints));
    let balances = phase == Phase::Balancing;
    let most_ma = if balances {
        MOST_BALANCING_MA
    } else {
        MOST_CURRENT_MA
    };
    if current_ma > most_ma {
        return Some(format!("a wheel was told {current_ma} mA"));
    }
    let shows_torque = row.driver == Driver::Pc && !balances;
    (shows_torque && torque_nm > row.most_torque_nm)
        .then(|| format!("a joint was told {torque_nm:.2} N·m"))
}

fn armed(wanted: &Armed, seen: &Observed, driving: bool) -> Vec<String> {
    let mut all = flags(&wanted.flags, seen);
    // An idle wheel has no current to be seen.
    let (wheels, joints) = (wheels(seen), joints(seen));
    all.extend(group("wheels", wanted.wheels, wheels, seen, driving));
    all.extend(group("joints", wanted.joints, joints, seen, true));
    let ran = |wires| zero_from(wires, seen).is_none();
    let (wheels_move, joints_move) = match wanted.after {
        After::Off => (false, false),
        After::Drives => (true, true),
        After::WheelsOnly => (true, false),
        After::JointsOnly => (false, true),
        After::WhatRan => (ran(wheels) || !driving && ran(joints), ran(joints)),
        After::PcWaits => return [all, pc_waited(seen, driving)].concat(),
        After::WheelsWait => return [all, waited("wheels", wheels, seen), back(seen)].concat(),
        After::JointsWait => return [all, waited("joints", joints, seen), back(seen)].concat(),
    };
    let obey = |from, to| wheels.iter().any(|wheel| wheel.told_torque_in(from, to));
    let hold = |from, to| joints.iter().any(|joint| joint.had_torque_in(from, to));
    all.extend(after("wheels", wheels_move, obey, seen));
    all.extend(after("joints", joints_move, hold, seen));
    all
}

/// Violations by motors that have torque before the stick is centred.
fn waited(name: &str, wires: &[Wire], seen: &Observed) -> Vec<String> {
    let Some(centred) = seen.centred else {
        return vec!["the stick was never centred".to_owned()];
    };
    let moved = wires
        .iter()
        .any(|wire| wire.had_torque_in(centred - STATE_WINDOW, centred));
    if moved {
        vec![format!("{name} do not wait for a centred stick")]
    } else {
        Vec::new()
    }
}

/// Violations by motors that have torque after the fault, before the PC has started from rest. It does so only after a
/// drive. Those that ran on during the fault may take a moment to stop.
fn pc_waited(seen: &Observed, driving: bool) -> Vec<String> {
    let until = match (driving, seen.centred) {
        (true, None) => return vec!["the PC never started from rest".to_owned()],
        (true, Some(centred)) => centred,
        (false, _) => seen.ended,
    };
    let mut all = Vec::new();
    for (name, wires) in [("wheels", wheels(seen)), ("joints", joints(seen))] {
        let from = match zero_from(wires, seen) {
            Some(_) => seen.fault_ended,
            None => until - STATE_WINDOW,
        };
        if wires.iter().any(|wire| wire.had_torque_in(from, until)) {
            all.push(format!("{name} move before the PC has started from rest"));
        }
    }
    if driving {
        all.extend(back(seen));
    }
    all
}

/// Violations by motors that do not follow their commands at the end of the run.
fn back(seen: &Observed) -> Vec<String> {
    let (from, to) = (seen.ended - STATE_WINDOW, seen.ended);
    let wheels = wheels(seen)
        .iter()
        .all(|wheel| wheel.told_torque_in(from, to));
    let joints = joints(seen)
        .iter()
        .all(|joint| joint.had_torque_in(from, to));
    [("wheels", wheels), ("joints", joints)]
        .into_iter()
        .filter(|(_, obeys)| !obeys)
        .map(|(name, _)| format!("{name} do not come back after a start from rest"))
        .collect()
}

fn wheels(seen: &Observed) -> &[Wire] {
    &seen.wheels
}

fn joints(seen: &Observed) -> &[Wire] {
    &seen.joints
}

/// Time from the start of the fault until no motor of the group has torque; `None` if one still has it.
pub fn zero_from(wires: &[Wire], seen: &Observed) -> Option<Ps> {
    let each = wires.iter().map(|wire| wire.zero_from(seen.fault_ended));
    let all: Option<Vec<Ps>> = each.collect();
    all?.into_iter()
        .max()
        .map(|at| at.saturating_sub(seen.struck))
}

pub fn group(
    name: &str,
    wanted: Group,
    wires: &[Wire],
    seen: &Observed,
    seen_to_run: bool,
) -> Vec<String> {
    let end = seen.fault_ended;
    let ms = |at: Ps| at as f64 / MS as f64;
    let zero = zero_from(wires, seen).map(ms);
    let violation = match (wanted, zero) {
        (Group::Zero(limit), None) => {
            format!("{name} have torque, and should not after {limit} ms")
        }
        (Group::Zero(limit), Some(at)) if at > limit => {
            format!("{name} have no torque after {at:.2} ms only, limit {limit}")
        }
        (Group::Runs, Some(at)) if seen_to_run && at < ms(end - STATE_WINDOW) => {
            format!("{name} stopped after {at:.2} ms and should not")
        }
        (Group::Runs, _) if !seen.armed_at_fault_end => format!("{name}: disarmed"),
        (Group::Unreachable, _) if wires.iter().any(|w| w.spoke_in(end - STATE_WINDOW, end)) => {
            format!("{name} get frames, and the fault should keep them away")
        }
        _ => return Vec::new(),
    };
    vec![violation]
}

fn after(name: &str, moves: bool, moved: impl Fn(Ps, Ps) -> bool, seen: &Observed) -> Vec<String> {
    let violation = if moves && !moved(seen.ended - STATE_WINDOW, seen.ended) {
        format!("{name} do not come back after the fault")
    } else if !moves && moved(seen.fault_ended, seen.ended) {
        format!("{name} move by themselves after the fault")
    } else {
        return Vec::new();
    };
    vec![violation]
}

fn disarmed(wanted: &Disarmed, seen: &Observed) -> Vec<String> {
    let mut all = flags(&wanted.flags, seen);
    for (when, wanted, did) in [
        ("during", wanted.arms_during, seen.armed_during_fault),
        ("after", wanted.arms_after, seen.armed_after_fault),
    ] {
        match wanted {
            Arms::Yes if !did => all.push(format!("does not arm {when} the fault")),
            Arms::No if did => all.push(format!("arms {when} the fault")),
            _ => {}
        }
    }
    let mut wires = wheels(seen).iter().chain(joints(seen));
    if wanted.moves == Moves::Never && wires.any(|wire| wire.had_torque_in(0, seen.ended)) {
        all.push("armed, it moves although the PC has not started from rest".to_owned());
    }
    all
}

pub fn flags(wanted: &Flags, seen: &Observed) -> Vec<String> {
    let rose = |flag: &&&str| seen.flags.contains(**flag);
    let missing = wanted.must.iter().filter(|flag| !rose(flag));
    let missing = missing.map(|flag| format!("flag {flag} did not rise"));
    let known = |flag: &&String| {
        let mut all = wanted.must.iter().chain(&wanted.may);
        all.any(|known| known == flag)
    };
    let extra = seen.flags.iter().filter(|flag| !known(flag));
    missing
        .chain(extra.map(|flag| format!("flag {flag} rose")))
        .collect()
}
