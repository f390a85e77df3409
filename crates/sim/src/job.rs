//! One run from files to files: it reads an image and a scenario, and writes summary, recording and report.

use std::{
    io,
    path::{Path, PathBuf},
    sync::Arc,
    time::Instant,
};

use robot_plant::world::{World, WorldConfig, WorldError};

use super::{
    faults::EventError,
    recording::{Recording, RecordingError},
    report::{self, Report},
    runner::{self, Observer, RunResult},
    scenario::{FlashContents, Scenario},
    summary::Summary,
    trace::Traces,
};
use crate::{
    machine::{Machine, MachineError, RegisterPatch, flash::PARAMETER_FLASH_BYTES},
    parameter_sectors,
    pc::{PcAccess, PcError},
};

pub struct Job {
    /// The firmware image, with symbols and debug information.
    pub elf: PathBuf,
    pub scenario: Scenario,
    /// A recorded trial to play through the sensor models.
    pub imu_trial: Option<PathBuf>,
    pub patches: Vec<RegisterPatch>,
    /// Whether a debug probe's tool with default options flashed and started the board.
    pub probe: bool,
    /// How programs on this computer take part. What they send is not reproducible.
    pub pc: PcAccess,
    /// Keeps the parameter sectors from one run to the next: read if it exists, instead of the scenario's image, and
    /// written at the end.
    pub flash_file: Option<PathBuf>,
}

#[derive(Debug, thiserror::Error)]
pub enum JobError {
    #[error(transparent)]
    World(#[from] WorldError),
    #[error(transparent)]
    Machine(#[from] MachineError),
    #[error(transparent)]
    Pc(#[from] PcError),
    #[error(transparent)]
    Event(#[from] EventError),
    #[error(transparent)]
    Recording(#[from] RecordingError),
    #[error(transparent)]
    Report(#[from] robot_chart::ChartError),
    #[error(
        "the scenario has a PC of its own, whose bytes would mix with your program's: leave out its `pc = …`, or --link; \
         scenarios/pc-pilot.toml has only the pilot"
    )]
    TwoPcs,
    #[error("cannot read {path}: {source}")]
    Read { path: PathBuf, source: io::Error },
    #[error("{path} has {bytes} bytes; the parameter sectors have {PARAMETER_FLASH_BYTES}")]
    FlashSize { path: PathBuf, bytes: usize },
    #[error("cannot write {path}: {source}")]
    Write { path: PathBuf, source: io::Error },
}

pub struct Outcome {
    pub result: RunResult,
    pub summary: Summary,
    /// The files that were written, in the order in which a user reads them.
    pub files: Vec<PathBuf>,
}

impl Job {
    /// Prepares the board at power-on.
    pub fn machine(&self) -> Result<Machine, JobError> {
        let world = World::new(WorldConfig {
            plant: self.scenario.plant,
            radio: self.scenario.radio,
            robot: Arc::clone(&self.scenario.robot),
            variation: self.scenario.variation,
            rs00_timeout: self.scenario.rs00_timeout,
            imu_temperature_c: self.scenario.imu_temperature_c,
            mounting: self.scenario.mounting,
            mag_mounting: self.scenario.mag_mounting,
            seed: self.scenario.seed,
            imu_trial: self.imu_trial.clone(),
            start: self.scenario.start,
            terrain: self.scenario.terrain,
        })?;
        let mut machine = Machine::new(&self.elf, world)?;
        for patch in &self.patches {
            machine.patch_register(*patch);
        }
        if self.probe {
            machine.attach_probe();
        }
        self.set_up_flash(&mut machine)?;
        Ok(machine)
    }

    fn set_up_flash(&self, machine: &mut Machine) -> Result<(), JobError> {
        let setup = &self.scenario.flash;
        machine.set_flash_times(setup.times);
        machine.set_flash_seed(setup.seed.unwrap_or(self.scenario.seed));
        let kept = self.flash_file.as_ref().filter(|file| file.exists());
        let path = match (kept, &setup.contents) {
            (Some(path), _) | (None, FlashContents::Image(path)) => path,
            (None, FlashContents::Erased) => return Ok(()),
            (None, FlashContents::Records(records)) => {
                machine.set_parameter_flash(&parameter_sectors::holding(records));
                return Ok(());
            }
        };
        let bytes = std::fs::read(path).map_err(|source| JobError::Read {
            path: path.clone(),
            source,
        })?;
        let whole = <&[u8; PARAMETER_FLASH_BYTES]>::try_from(bytes.as_slice());
        let whole = whole.map_err(|_| JobError::FlashSize {
            path: path.clone(),
            bytes: bytes.len(),
        })?;
        machine.set_parameter_flash(whole);
        Ok(())
    }

    fn keep_flash(&self, machine: &mut Machine) -> Result<(), JobError> {
        let Some(path) = &self.flash_file else {
            return Ok(());
        };
        std::fs::write(path, machine.parameter_flash()).map_err(|source| JobError::Write {
            path: path.clone(),
            source,
        })
    }

    /// Runs, and writes only the flash file.
    pub fn run(&self, observers: &mut [&mut dyn Observer]) -> Result<Outcome, JobError> {
        if self.pc.link_on_pty && self.scenario.has_pc() {
            return Err(JobError::TwoPcs);
        }
        let mut machine = self.machine()?;
        let mut ports = self.pc.open()?;
        let started = Instant::now();
        let result = runner::run(&mut machine, &self.scenario, &mut ports, observers)?;
        let summary = Summary::new(&self.scenario, &result, started.elapsed());
        self.keep_flash(&mut machine)?;
        Ok(Outcome {
            result,
            summary,
            files: Vec::new(),
        })
    }

    /// Runs, and writes `report.html`, `summary.json` and `run.mcap` into the folder `out`, which is created if necessary.
    pub fn run_into(&self, out: &Path, watcher: &mut dyn Observer) -> Result<Outcome, JobError> {
        let failed = |path: &Path, source| JobError::Write {
            path: path.to_owned(),
            source,
        };
        std::fs::create_dir_all(out).map_err(|e| failed(out, e))?;
        let files = ["report.html", "summary.json", "run.mcap"].map(|name| out.join(name));
        let [report_path, summary_path, recording_path] = &files;
        let mut recording = Recording::create(
            recording_path,
            Arc::clone(&self.scenario.robot),
            self.scenario.terrain,
        )?;
        let mut traces = Traces::new(self.scenario.length);
        let mut outcome = self.run(&mut [watcher, &mut recording, &mut traces])?;
        recording.finish()?;
        let json = outcome.summary.to_json();
        std::fs::write(summary_path, json).map_err(|e| failed(summary_path, e))?;
        let html = report::render(&Report {
            scenario: &self.scenario,
            result: &outcome.result,
            summary: &outcome.summary,
            traces: &traces,
        })?;
        std::fs::write(report_path, html).map_err(|e| failed(report_path, e))?;
        outcome.files = files.to_vec();
        Ok(outcome)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_pcs_do_not_share_the_link() {
        let text =
            "name = \"two\"\nseconds = 1\nplant = \"stand\"\n[[at]]\nt = 0.5\npc = { on = true }\n";
        let job = Job {
            elf: PathBuf::new(),
            scenario: Scenario::parse(text, "two").expect("it parses"),
            imu_trial: None,
            patches: Vec::new(),
            probe: false,
            pc: PcAccess {
                link_on_pty: true,
                ..PcAccess::default()
            },
            flash_file: None,
        };
        assert!(matches!(job.run(&mut []), Err(JobError::TwoPcs)));
    }
}
