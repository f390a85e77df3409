//! Every fault in every phase of a drive, on the shipped image: which parts stop, how soon and with which flags, and what
//! happens after the end of the fault.
//!
//! `matrix/expected.rs` holds what must happen. `docs/safety.md` shows it, with the times measured when it was written
//! (`ROBOT_WRITE_MATRIX=1` writes it again). `ROBOT_MATRIX=motor-3` runs only the faults whose names contain that.

mod support;

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
use row::Row;

/// Observations by row and phase.
type Cells = BTreeMap<(usize, Phase), Observed>;

/// Runs every cell of the rows on all cores.
fn run_all(rows: &[Row]) -> Cells {
    let all = (0..rows.len()).flat_map(|row| Phase::ALL.map(|phase| (row, phase)));
    let queue = Mutex::new(all);
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

fn chosen() -> Vec<Row> {
    let part = std::env::var("ROBOT_MATRIX").unwrap_or_default();
    let rows = expected::rows().into_iter();
    rows.filter(|row| row.fault.contains(&part)).collect()
}

#[test]
fn every_fault_in_every_phase_ends_as_it_must() {
    support::image();
    let rows = chosen();
    let cells = run_all(&rows);
    let mut wrong = Vec::new();
    for (index, row) in rows.iter().enumerate() {
        for phase in Phase::ALL {
            let seen = &cells[&(index, phase)];
            println!("{}", document::line(row, phase, seen));
            let violations = judge::violations(row, phase, seen).into_iter();
            let fault = document::name(row);
            wrong.extend(violations.map(|what| format!("{fault}, {phase}: {what}")));
        }
    }
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
    if std::env::var_os("ROBOT_WRITE_MATRIX").is_some() && rows.len() == expected::rows().len() {
        document::write(&rows, &cells);
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
fn the_document_shows_the_matrix() {
    document::check(&expected::rows());
}
