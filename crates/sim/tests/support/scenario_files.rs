//! Runs a folder of scenarios on an image.

use std::{
    path::{Path, PathBuf},
    sync::Mutex,
    thread,
};

use robot_sim::{
    job::{Job, Outcome},
    scenario::Scenario,
};

use crate::support;

/// Asserts that every scenario in `folder` holds on `elf`, and prints which did.
pub fn must_hold(folder: &Path, elf: &Path) {
    let files = files(folder);
    assert!(!files.is_empty());
    let queue = Mutex::new(files.iter());
    let failures = Mutex::new(Vec::new());
    let workers = thread::available_parallelism().map_or(1, |n| n.get());
    thread::scope(|scope| {
        for _ in 0..workers {
            scope.spawn(|| {
                while let Some(path) = { queue.lock().unwrap().next() } {
                    let problems = run(path, elf);
                    let name = path.file_name().unwrap_or_default().to_string_lossy();
                    println!(
                        "{name}: {}",
                        if problems.is_empty() {
                            "held"
                        } else {
                            "FAILED"
                        }
                    );
                    let mut failures = failures.lock().unwrap();
                    failures.extend(problems.iter().map(|c| format!("{name}: {c}")));
                }
            });
        }
    });
    let failures = failures.into_inner().unwrap();
    assert!(failures.is_empty(), "\n{}", failures.join("\n"));
}

fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).expect("the folder of scenarios is there");
    let mut files: Vec<PathBuf> = entries
        .map(|entry| entry.expect("a readable entry").path())
        .filter(|path| path.extension().is_some_and(|e| e == "toml"))
        .collect();
    files.sort();
    files
}

fn run(path: &Path, elf: &Path) -> Vec<String> {
    let scenario = match Scenario::read(path) {
        Ok(scenario) => scenario,
        Err(error) => return vec![error.to_string()],
    };
    let job = Job {
        elf: elf.to_owned(),
        ..support::job(scenario)
    };
    match job.run(&mut []) {
        Ok(outcome) => problems(&outcome),
        Err(error) => vec![error.to_string()],
    }
}

/// The failures of a run, one line each.
fn problems(outcome: &Outcome) -> Vec<String> {
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
