//! Same image, scenario and seed give the same bytes; another seed gives other noise.

mod support;

use std::path::Path;

use robot_sim::{
    machine::LogLine,
    runner::Observer,
    scenario::Scenario,
    signals::{SignalTable, Values},
};

struct Nobody;

impl Observer for Nobody {
    fn sample(&mut self, _: u64, _: &SignalTable, _: &Values) {}
    fn log(&mut self, _: &LogLine) {}
}

fn scenario(seed: u64) -> Scenario {
    let path = robot_test_support::repository().join("scenarios/drive-rolling.toml");
    let mut scenario = Scenario::read(&path).expect("the scenario is there");
    scenario.length = 4_000_000_000_000;
    scenario.seed = seed;
    scenario
}

/// `summary.json` without what the computer's speed decides, and the whole recording.
fn run(seed: u64, out: &Path) -> (String, Vec<u8>) {
    support::job(scenario(seed))
        .run_into(out, &mut Nobody)
        .expect("the run goes through");
    let summary = std::fs::read_to_string(out.join("summary.json")).expect("a summary");
    let lines = summary.lines();
    let timeless = lines.filter(|l| !l.contains("wall_seconds") && !l.contains("realtime_factor"));
    let recording = std::fs::read(out.join("run.mcap")).expect("a recording");
    (timeless.collect::<Vec<_>>().join("\n"), recording)
}

#[test]
fn the_same_run_twice_gives_the_same_bytes() {
    let out = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let first = run(7, &out.join("determinism-a"));
    let second = run(7, &out.join("determinism-b"));
    assert_eq!(first.0, second.0);
    assert!(first.1 == second.1, "the recordings differ");
    let other = run(8, &out.join("determinism-c"));
    assert_ne!(first.0, other.0, "the seed reaches the noise");
}
