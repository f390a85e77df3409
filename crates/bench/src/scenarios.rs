//! Runs the shipped image on the emulated board.

use std::path::Path;

use anyhow::{Context, ensure};
use robot_plant::time::{MS, Ps};
use robot_sim::{
    job::Job,
    machine::LogLine,
    pc::PcAccess,
    runner::Observer,
    scenario::Scenario,
    signals::{SignalTable, Values},
    summary::Summary,
};

/// Scenarios that load the board: ordinary driving, and the most traffic on every line.
pub const NAMES: [&str; 2] = ["drive", "full-traffic"];

/// Returns the length of the scenario in simulated milliseconds.
pub fn length_ms(scenario: &Scenario) -> u64 {
    scenario.length / MS
}

pub fn read(repository: &Path, name: &str) -> anyhow::Result<Scenario> {
    let path = repository.join(format!("scenarios/{name}.toml"));
    Scenario::read(&path).with_context(|| format!("scenario {name}"))
}

/// Runs the scenario and calls `progress` after each simulated millisecond. It fails if an expectation does not hold.
pub fn run(elf: &Path, scenario: Scenario, progress: impl FnMut()) -> anyhow::Result<Summary> {
    let name = scenario.name.clone();
    let job = Job {
        elf: elf.to_owned(),
        scenario,
        imu_trial: None,
        patches: Vec::new(),
        probe: false,
        pc: PcAccess::default(),
        flash_file: None,
    };
    let mut watcher = Watcher { next: 0, progress };
    let summary = job.run(&mut [&mut watcher])?.summary;
    ensure!(
        summary.ok,
        "{name}: the scenario failed; `cargo xtask sim` with it says why"
    );
    Ok(summary)
}

struct Watcher<P> {
    next: Ps,
    progress: P,
}

impl<P: FnMut()> Observer for Watcher<P> {
    fn sample(&mut self, at: Ps, _: &SignalTable, _: &Values) {
        while self.next < at {
            (self.progress)();
            self.next += MS;
        }
    }

    fn log(&mut self, _: &LogLine) {}
}
