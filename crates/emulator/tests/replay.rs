//! Recorded motion played through the sensor models into the shipped image: every trial, from start to end.

mod support;

use std::{
    fs,
    path::{Path, PathBuf},
    sync::{Mutex, PoisonError},
    thread,
};

use robot_emulator::sim::{scenario::Scenario, summary::AttitudeError};
use robot_plant::recording;

/// Each thread emulates one board; the trials take longest first, so that no thread ends much later than the other.
const THREADS: usize = 2;

/// The trials, where this computer has them.
fn recordings() -> Option<Vec<PathBuf>> {
    let data = std::env::var_os("ROBOT_DATA").map_or_else(
        || support::repository().join("../shared/data/broad"),
        PathBuf::from,
    );
    let files = fs::read_dir(data.join("hz200")).ok()?;
    let paths = files.filter_map(|file| Some(file.ok()?.path()));
    let headers: Vec<_> = paths
        .filter(|p| p.extension().is_some_and(|e| e == "json"))
        .collect();
    (!headers.is_empty()).then_some(headers)
}

fn name(trial: &Path) -> String {
    let stem = trial.file_stem().unwrap_or_default();
    stem.to_string_lossy().into_owned()
}

fn replay(trial: &Path) -> AttitudeError {
    let text = "name = \"replay\"\nseconds = 1\nplant = \"stand\"\n";
    let mut job = support::job(Scenario::parse(text, "replay").expect("it parses"));
    job.scenario.length = recording::run_length(trial).expect("a trial");
    job.imu_trial = Some(trial.to_owned());
    let outcome = job.run(&mut []).expect("the machine starts");
    assert!(outcome.summary.ok, "{:?}", outcome.summary.board_errors);
    assert_eq!(outcome.summary.control.missed, 0);
    outcome
        .summary
        .attitude_error
        .expect("something was scored")
}

/// Trials with their scores, in the order of their names.
fn replay_all(mut trials: Vec<PathBuf>) -> Vec<(String, AttitudeError)> {
    trials.sort_by_key(|trial| recording::run_length(trial).expect("a trial"));
    let waiting = Mutex::new(trials);
    let next = || waiting.lock().unwrap_or_else(PoisonError::into_inner).pop();
    let work = || {
        let mut scores = Vec::new();
        while let Some(trial) = next() {
            scores.push((name(&trial), replay(&trial)));
        }
        scores
    };
    let mut scores: Vec<_> = thread::scope(|scope| {
        let threads: Vec<_> = (0..THREADS).map(|_| scope.spawn(work)).collect();
        let joined = threads.into_iter().map(|thread| thread.join());
        joined
            .flat_map(|scores| scores.expect("no replay failed"))
            .collect()
    });
    scores.sort_by(|a, b| a.0.cmp(&b.0));
    scores
}

/// The metric is that of `data/broad/score.py` at the estimate's times: the movement phase at 1 kHz, gaps of the
/// reference skipped, no alignment of any kind. The lead-in before a record is at rest and is not scored.
///
/// The estimator alone, fed with the records as they are (`host-tests`, `recorded_motion`), has 0.84° of inclination in
/// the mean; in the image it has 0.88°, and no trial differs by 0.1°. Heading differs more, up to 1.7° (trial 21), and
/// which of the chips' resolution, filters and conversion times does that has not been measured. The bounds are what was
/// measured (0.88° and at most 1.93°) and a fifth more; the mean's is kept at 1°.
///
/// It takes 9 minutes of processor time: half of that where two cores are free.
#[test]
fn the_attitude_follows_every_recorded_trial() {
    let Some(trials) = recordings() else {
        println!(
            "skipped: no recorded trials at ../shared/data/broad (set ROBOT_DATA to their folder)"
        );
        return;
    };
    let scores = replay_all(trials);
    println!(
        "{:50} {:>8} {:>8} {:>8}",
        "RMSE in degrees", "total", "heading", "incl"
    );
    let row = |name: &str, [total, heading, inclination]: [f64; 3]| {
        println!("{name:50} {total:8.2} {heading:8.2} {inclination:8.2}");
    };
    let mut mean = [0.0; 3];
    for (name, error) in &scores {
        let degrees = [
            error.total_rmse_deg,
            error.heading_rmse_deg,
            error.inclination_rmse_deg,
        ];
        row(name, degrees);
        for (sum, part) in mean.iter_mut().zip(degrees) {
            *sum += part / scores.len() as f64;
        }
    }
    row("mean", mean);
    for (name, error) in &scores {
        assert!(
            error.samples > 10_000,
            "{name}: {} ms scored",
            error.samples
        );
        assert!(
            error.inclination_rmse_deg < 2.3,
            "{name}: inclination off by {:.2}° RMSE",
            error.inclination_rmse_deg
        );
    }
    assert!(
        mean[2] < 1.0,
        "inclination off by {:.2}° in the mean",
        mean[2]
    );
}
