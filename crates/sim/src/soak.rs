//! Runs the robot for hours with pilot input, faults and frames drawn from a seed, and checks invariants at every instant.

mod flash_at_rest;
mod initial_flash;
mod invariants;
mod missing_signal;
mod pc_program;
mod plan;
mod reproduction;
mod rng;
mod saved_settings;
mod settings_check;
mod stop_deadlines;
mod tuning_frames;

use std::{path::PathBuf, sync::Arc};

use robot_description::Robot;
use robot_plant::{
    time::{self, MS, Ps, SECOND},
    world::{World, WorldConfig, WorldError},
};

use crate::{
    faults::EventError,
    machine::{Machine, MachineError, faults::FaultError},
    scenario::TimedEvent,
    simulation::Simulation,
};

use invariants::Invariants;
pub use invariants::{Tally, Violation};
use missing_signal::MissingSignal;
use plan::Plan;
pub use saved_settings::SettingsTally;

/// Invariants are checked, and events happen, on this grid.
const STEP: Ps = MS;
/// The reproduction of a violation repeats the events of this span of time before it.
const REPRODUCED: Ps = 30 * SECOND;

#[derive(Clone, Debug)]
pub struct Soak {
    /// The firmware image, with symbols and debug information.
    pub elf: PathBuf,
    /// The robot that the image is for.
    pub robot: Arc<Robot>,
    pub length: Ps,
    pub seed: u64,
}

#[derive(Debug, thiserror::Error)]
pub enum SoakError {
    #[error(transparent)]
    World(#[from] WorldError),
    #[error(transparent)]
    Machine(#[from] MachineError),
    #[error(transparent)]
    Event(#[from] EventError),
    #[error("the image lacks what the soak watches: {0}")]
    MissingSignal(#[from] MissingSignal),
}

/// Length of the run, and the first violation.
#[derive(Clone, Debug)]
pub struct Outcome {
    pub ran: Ps,
    pub tally: Tally,
    pub failure: Option<Failure>,
}

#[derive(Clone, Debug)]
pub struct Failure {
    pub violation: Violation,
    /// A scenario that repeats the events before the violation.
    pub scenario: String,
}

impl Soak {
    /// Runs to the end or to the first violation; calls `progress` every simulated second.
    pub fn run(&self, mut progress: impl FnMut(Ps)) -> Result<Outcome, SoakError> {
        let world = World::new(WorldConfig {
            seed: self.seed,
            robot: Arc::clone(&self.robot),
            ..WorldConfig::default()
        })?;
        let mut machine = Machine::new(&self.elf, world)?;
        machine.set_flash_seed(self.seed);
        machine.set_parameter_flash(&initial_flash::contents());
        let mut invariants = Invariants::new(&mut machine)?;
        let mut plan = Plan::new(self.seed, self.length);
        let mut done: Vec<TimedEvent> = Vec::new();
        let mut now = 0;
        while now < self.length {
            while let Some(timed) = plan.next_until(now) {
                match Simulation::apply(&mut machine, &timed.event) {
                    // The chip is booting, and no task runs yet that could fail.
                    Err(EventError::Machine(FaultError::NotThere { .. })) => continue,
                    // The bus has been down for so long that the adapter's queue is full.
                    Err(EventError::AdapterFull) => continue,
                    other => other?,
                }
                invariants.record(&timed);
                done.push(timed);
            }
            now += STEP;
            let stopped = machine.run_until(now).err();
            let broken = match stopped {
                Some(why) => Some(Violation {
                    at: now,
                    what: why.to_string(),
                }),
                None => invariants.check(&mut machine, now),
            };
            if let Some(violation) = broken {
                let scenario = reproduction::scenario(&done, &violation, self.seed, REPRODUCED);
                let failure = Some(Failure {
                    violation,
                    scenario,
                });
                return Ok(self.outcome(now, invariants, failure));
            }
            if now.is_multiple_of(SECOND) {
                machine.take_log();
                progress(now);
            }
        }
        Ok(self.outcome(now, invariants, None))
    }

    fn outcome(&self, ran: Ps, invariants: Invariants, failure: Option<Failure>) -> Outcome {
        Outcome {
            ran,
            tally: invariants.tally(),
            failure,
        }
    }
}

impl std::fmt::Display for Failure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Violation { at, what } = &self.violation;
        write!(f, "at {:.3} s: {what}", time::to_seconds(*at))
    }
}
