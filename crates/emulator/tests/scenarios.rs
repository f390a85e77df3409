//! Every file in `scenarios/` holds on the shipped image.

mod support;

use std::{
    path::{Path, PathBuf},
    sync::Mutex,
    thread,
};

use robot_emulator::sim::{job::Outcome, scenario::Scenario};

fn files() -> Vec<PathBuf> {
    let folder = support::repository().join("scenarios");
    let entries = std::fs::read_dir(&folder).expect("scenarios/ is there");
    let mut files: Vec<PathBuf> = entries
        .map(|entry| entry.expect("a readable entry").path())
        .filter(|path| path.extension().is_some_and(|e| e == "toml"))
        .collect();
    files.sort();
    files
}

/// What went wrong, one line each.
fn complaints(outcome: &Outcome) -> Vec<String> {
    let summary = &outcome.summary;
    let stopped = summary.stopped.iter().map(|why| format!("stopped: {why}"));
    let errors = summary.board_errors.iter();
    let failed = summary.failed_expectations.iter();
    stopped
        .chain(errors.map(|e| format!("board error at {:.4} s: {}", e.at, e.message)))
        .chain(failed.map(|f| {
            format!(
                "{} {} from {} to {} s: {}",
                f.signal, f.expected, f.from, f.to, f.why
            )
        }))
        .collect()
}

fn run(path: &Path) -> Vec<String> {
    match Scenario::read(path) {
        Ok(scenario) => match support::job(scenario).run(&mut []) {
            Ok(outcome) => complaints(&outcome),
            Err(error) => vec![error.to_string()],
        },
        Err(error) => vec![error.to_string()],
    }
}

#[test]
fn every_scenario_holds() {
    support::image();
    let files = files();
    assert!(!files.is_empty());
    let queue = Mutex::new(files.iter());
    let failures = Mutex::new(Vec::new());
    let workers = thread::available_parallelism().map_or(1, |n| n.get());
    thread::scope(|scope| {
        for _ in 0..workers {
            scope.spawn(|| {
                while let Some(path) = { queue.lock().unwrap().next() } {
                    let complaints = run(path);
                    let name = path.file_name().unwrap_or_default().to_string_lossy();
                    println!(
                        "{name}: {}",
                        if complaints.is_empty() {
                            "held"
                        } else {
                            "FAILED"
                        }
                    );
                    let mut failures = failures.lock().unwrap();
                    failures.extend(complaints.iter().map(|c| format!("{name}: {c}")));
                }
            });
        }
    });
    let failures = failures.into_inner().unwrap();
    assert!(failures.is_empty(), "\n{}", failures.join("\n"));
}
