//! The matrix as the table of `docs/safety.md`.

use std::{fs, path::PathBuf};

use robot_plant::time::MS;

use crate::{
    Cells,
    balancing_expected::{Balancing, Outcome},
    driver::Driver,
    judge,
    observed::{Observed, Phase, Wire},
    row::{After, Armed, Arms, Disarmed, Flags, Group, Moves, Row},
};

const BEGIN: &str = "<!-- matrix: written by ROBOT_WRITE_MATRIX=1 cargo test --test matrix -->";
const END: &str = "<!-- matrix ends -->";

fn path() -> PathBuf {
    robot_test_support::repository().join("docs/safety.md")
}

/// Text before the matrix, the matrix, text after it.
fn parts(text: &str) -> (&str, &str, &str) {
    let (before, rest) = text
        .split_once(BEGIN)
        .expect("docs/safety.md has the matrix's begin");
    let (matrix, after) = rest
        .split_once(END)
        .expect("docs/safety.md has the matrix's end");
    (before, matrix, after)
}

pub fn write(rows: &[Row], cells: &Cells) {
    let text = fs::read_to_string(path()).expect("docs/safety.md is there");
    let (before, _, after) = parts(&text);
    let table = table(rows, |index, phase| cells.get(&(index, phase)));
    let text = format!("{before}{BEGIN}\n\n{table}\n{END}{after}");
    fs::write(path(), text).expect("docs/safety.md can be written");
}

/// The document has the same rows and outcomes; measured times may differ.
pub fn check(rows: &[Row]) {
    let text = fs::read_to_string(path()).expect("docs/safety.md is there");
    let (_, matrix, _) = parts(&text);
    let lines = |text: &str| {
        let lines = text.lines().map(without_measured);
        lines.filter(|line| !line.is_empty()).collect::<Vec<_>>()
    };
    let (written, wanted) = (lines(matrix), lines(&table(rows, |_, _| None)));
    for (written, wanted) in written.iter().zip(&wanted) {
        assert_eq!(
            written, wanted,
            "write docs/safety.md again: ROBOT_WRITE_MATRIX=1"
        );
    }
    assert_eq!(written.len(), wanted.len());
}

/// Measured times stand in brackets.
fn without_measured(line: &str) -> String {
    let mut kept = String::new();
    let mut rest = line;
    while let Some((before, inside)) = rest.split_once(" [") {
        kept += before;
        rest = inside.split_once(']').map_or("", |(_, after)| after);
    }
    kept + rest
}

fn table<'a>(rows: &[Row], seen: impl Fn(usize, Phase) -> Option<&'a Observed>) -> String {
    let mut text =
        "| fault | armed, driving | armed, idle | disarmed | balancing |\n|---|---|---|---|---|\n"
            .to_owned();
    for (index, row) in rows.iter().enumerate() {
        let cell = |phase| cell(row, phase, seen(index, phase));
        let [driving, idle, disarmed, balancing] = Phase::ALL.map(cell);
        let fault = name(row);
        text += &format!("| {fault} | {driving} | {idle} | {disarmed} | {balancing} |\n");
    }
    text
}

/// The first column.
pub fn name(row: &Row) -> String {
    let fault = row.fault;
    match row.driver {
        Driver::Pilot => format!("`{fault}`"),
        Driver::PilotBesidePc => format!("`{fault}`, mode manual"),
        Driver::Pc => format!("`{fault}`, mode PC"),
    }
}

/// One cell for the terminal.
pub fn line(row: &Row, phase: Phase, seen: &Observed) -> String {
    let flags: Vec<&str> = seen.flags.iter().map(String::as_str).collect();
    let cell = cell(row, phase, Some(seen));
    format!(
        "{:<24} {phase:<15} {cell}; seen: {}",
        name(row),
        flags.join(" ")
    )
}

fn cell(row: &Row, phase: Phase, seen: Option<&Observed>) -> String {
    match phase {
        Phase::Driving => armed(&row.driving, seen),
        Phase::Idle => armed(&row.idle, seen),
        Phase::Disarmed => disarmed(&row.disarmed),
        Phase::Balancing => balancing(&row.balancing, seen),
    }
}

fn armed(wanted: &Armed, seen: Option<&Observed>) -> String {
    let flags = flags(&wanted.flags);
    let after = match wanted.after {
        After::Off => "stays off",
        After::Drives => "then drives on",
        After::WheelsOnly => "then wheels drive on",
        After::JointsOnly => "then joints hold on",
        After::WhatRan => "what stopped stays off",
        After::PcWaits => "then all waits until the PC starts from rest",
        After::WheelsWait => "then wheels wait until the stick is centred",
        After::JointsWait => "then joints wait until the stick is centred",
    };
    match (wanted.wheels, wanted.joints) {
        (Group::Runs, Group::Runs) if wanted.after == After::Drives => format!("{flags}runs on"),
        (Group::Runs, Group::Runs) => format!("{flags}runs on; {after}"),
        (Group::Either, Group::Either) => format!("{flags}may stop; {after}"),
        (wheels, joints) => format!("{flags}{}; {after}", stop(wheels, joints, seen)),
    }
}

/// How soon motors are without torque.
fn stop(wheels: Group, joints: Group, seen: Option<&Observed>) -> String {
    let wheels_seen = seen.map(|seen| measured(&seen.wheels, seen));
    let joints_seen = seen.map(|seen| measured(&seen.joints, seen));
    match (wheels, joints) {
        (Group::Zero(wheels_ms), Group::Zero(joints_ms)) if wheels_ms == joints_ms => {
            let both = wheels_seen.zip(joints_seen);
            let both = both.map(|(wheels, joints)| format!(" [wheels {wheels}, joints {joints}]"));
            format!("all 0 within {wheels_ms} ms{}", both.unwrap_or_default())
        }
        _ => {
            let wheels = group(wheels, wheels_seen);
            let joints = group(joints, joints_seen);
            format!("wheels {wheels}, joints {joints}")
        }
    }
}

fn measured(wires: &[Wire], seen: &Observed) -> String {
    let zero = judge::zero_from(wires, seen);
    zero.map_or("–".into(), |at| format!("{:.1}", at as f64 / MS as f64))
}

fn group(wanted: Group, measured: Option<String>) -> String {
    match wanted {
        Group::Zero(limit) => {
            let measured = measured.map_or(String::new(), |ms| format!(" [{ms}]"));
            format!("0 within {limit} ms{measured}")
        }
        Group::Runs => "run".into(),
        Group::Either => "may stop".into(),
        Group::Unreachable => "out of reach".into(),
    }
}

fn disarmed(wanted: &Disarmed) -> String {
    let arms = |when, arms| match arms {
        Arms::Yes => format!("arms {when}"),
        Arms::No => format!("no arming {when}"),
        Arms::Either => format!("may arm {when}"),
    };
    let flags = flags(&wanted.flags);
    let during = arms("during it", wanted.arms_during);
    let after = arms("after it", wanted.arms_after);
    let still = match wanted.moves {
        Moves::AsArmed => "",
        Moves::Never => ", then all waits until the PC starts from rest",
    };
    format!("{flags}{during}, {after}{still}")
}

fn balancing(wanted: &Balancing, seen: Option<&Observed>) -> String {
    let flags = flags(&wanted.flags);
    let says = match wanted.outcome {
        Outcome::Drives => "balances and drives on".to_owned(),
        Outcome::Balances => "balances on".to_owned(),
        Outcome::OnTheSpot => "balances on the spot until the PC starts from rest".to_owned(),
        Outcome::Either => "may fall".to_owned(),
        Outcome::LetsGo { wheels, joints } => {
            let latched = match wanted.arms_after {
                Arms::No => "stays off until it is cleared or asked to stand",
                Arms::Yes | Arms::Either => "stays off",
            };
            format!("{}; {latched}", stop(wheels, joints, seen))
        }
    };
    format!("{flags}{says}")
}

fn flags(flags: &Flags) -> String {
    if flags.must.is_empty() && flags.may.is_empty() {
        return String::new();
    }
    let must = flags.must.iter().map(|flag| format!("`{flag}`"));
    let may = flags.may.iter().map(|flag| format!("(`{flag}`)"));
    let all: Vec<String> = must.chain(may).collect();
    format!("{}; ", all.join(" "))
}
