//! Every fault in every phase of a drive, on the shipped image: which parts stop, how soon and with which flags, and what
//! happens after the end of the fault.
//!
//! `matrix/expected.rs` holds what must happen. `docs/safety.md` shows it, with the times measured when it was written
//! (`ROBOT_WRITE_MATRIX=1` writes it again). `ROBOT_MATRIX=motor-3` runs only the faults whose names contain that.
//!
//! Unless `ROBOT_MATRIX` names some, every fault meets a robot that drives, and by turns one that idles or is disarmed. A robot
//! that balances takes long to stand up, so it meets fewer of them. `ROBOT_MATRIX=all` stands for all, as `cargo xtask test --whole`
//! does, and `ROBOT_MATRIX=balancing` leaves out the other robots.

mod support;

#[path = "matrix/balancing/course.rs"]
mod balancing_course;
#[path = "matrix/balancing/expected.rs"]
mod balancing_expected;
#[path = "matrix/balancing/judge.rs"]
mod balancing_judge;
#[path = "matrix/document.rs"]
mod document;
#[path = "matrix/drive.rs"]
mod drive;
#[path = "matrix/driver.rs"]
mod driver;
#[path = "matrix/expected.rs"]
mod expected;
#[path = "matrix/judge.rs"]
mod judge;
#[path = "matrix/link_rows.rs"]
mod link_rows;
#[path = "matrix/observed.rs"]
mod observed;
#[path = "matrix/pc_law.rs"]
mod pc_law;
#[path = "matrix/row.rs"]
mod row;

use std::{
    collections::BTreeMap,
    sync::{Mutex, PoisonError},
    thread,
};

use observed::{Observed, Phase};
use robot_sim::faults;
use robot_test_support::is_whole;
use row::Row;

/// Values of `ROBOT_MATRIX`: every fault, and every fault for a robot that balances only.
const ALL: &str = "all";
const BALANCING: &str = "balancing";

/// Observations by row and phase.
type Cells = BTreeMap<(usize, Phase), Observed>;

/// Runs the cells of the rows on all cores.
fn run_all(choice: &Choice) -> Cells {
    let rows = &choice.rows;
    let all = (0..rows.len()).flat_map(|row| Phase::ALL.map(|phase| (row, phase)));
    let all = all.filter(|(row, phase)| choice.has(*row, *phase));
    let all: Vec<_> = all.collect();
    let queue = Mutex::new(all.into_iter());
    let next = || queue.lock().unwrap_or_else(PoisonError::into_inner).next();
    let work = || {
        let mut cells = Vec::new();
        while let Some((row, phase)) = next() {
            cells.push(((row, phase), drive::run(&rows[row], phase)));
        }
        cells
    };
    let cores = thread::available_parallelism().map_or(1, |n| n.get());
    thread::scope(|scope| {
        let threads: Vec<_> = (0..cores).map(|_| scope.spawn(work)).collect();
        let joined = threads.into_iter().map(|thread| thread.join());
        joined
            .flat_map(|cells| cells.expect("no run failed"))
            .collect()
    })
}

/// The cells that a run tests.
struct Choice {
    rows: Vec<Row>,
    /// Whether every row meets every phase, not only a sample of them.
    whole: bool,
    /// Whether no other robot is tested.
    only_balancing: bool,
}

impl Choice {
    /// What `ROBOT_MATRIX` asks for.
    fn wished() -> Self {
        let wish = std::env::var("ROBOT_MATRIX").ok();
        let part = wish
            .as_deref()
            .filter(|wish| ![ALL, BALANCING].contains(wish));
        let rows = expected::rows().into_iter();
        Self {
            rows: rows
                .filter(|row| row.fault.contains(part.unwrap_or_default()))
                .collect(),
            whole: wish.is_some() || writes() || is_whole(),
            only_balancing: wish.as_deref() == Some(BALANCING),
        }
    }

    /// The sample: each row meets a robot that drives, and by turns one that idles or is disarmed.
    fn has(&self, place: usize, phase: Phase) -> bool {
        let balances = |row: &Row| expected::BALANCING_SAMPLE.contains(&row.fault);
        match phase {
            Phase::Balancing => self.whole || self.rows.get(place).is_some_and(balances),
            _ if self.only_balancing => false,
            Phase::Driving => true,
            Phase::Idle => self.whole || place.is_multiple_of(2),
            Phase::Disarmed => self.whole || !place.is_multiple_of(2),
        }
    }
}

fn writes() -> bool {
    std::env::var_os("ROBOT_WRITE_MATRIX").is_some()
}

#[test]
fn every_fault_in_every_phase_ends_as_it_must() {
    robot_test_support::image();
    let choice = Choice::wished();
    let cells = run_all(&choice);
    let rows = &choice.rows;
    let mut wrong = Vec::new();
    for (index, row) in rows.iter().enumerate() {
        for phase in Phase::ALL {
            let Some(seen) = cells.get(&(index, phase)) else {
                continue;
            };
            println!("{}", document::line(row, phase, seen));
            let violations = judge::violations(row, phase, seen).into_iter();
            let fault = document::name(row);
            wrong.extend(violations.map(|what| format!("{fault}, {phase}: {what}")));
        }
    }
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
    let is_all = rows.len() == expected::rows().len() && !choice.only_balancing;
    if writes() && is_all {
        document::write(rows, &cells);
    }
}

#[test]
fn every_fault_has_a_row() {
    let rows = expected::rows();
    let missing: Vec<_> = faults::all()
        .map(|fault| fault.name)
        .filter(|name| !rows.iter().any(|row| row.fault == *name))
        .collect();
    assert!(missing.is_empty(), "no row for {missing:?}");
}

#[test]
fn the_sample_while_balancing_consists_of_rows() {
    let rows = expected::rows();
    let mut unknown = expected::BALANCING_SAMPLE.iter();
    let unknown = unknown.find(|name| !rows.iter().any(|row| row.fault == **name));
    assert_eq!(unknown, None);
}

#[test]
fn the_document_shows_the_matrix() {
    document::check(&expected::rows());
}
