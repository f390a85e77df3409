//! The robot for hours: a pilot, faults and frames from a seed, and rules that must hold at every instant.

mod dice;
mod duty;
mod full_sectors;
mod harmless;
mod kept;
mod plan;
mod reproduction;
mod settings;
mod still_flash;
mod watch;

use std::path::PathBuf;

use robot_plant::{
    time::{self, MS, Ps, SECOND},
    world::{World, WorldConfig, WorldError},
};

use crate::{
    faults::DeedError,
    machine::{Machine, MachineError, faults::FaultError},
    scenario::Action,
    simulation::Simulation,
};

pub use kept::KeptTally;
use plan::Plan;
use watch::Watch;
pub use watch::{Tally, Violation};

/// Rules are checked, and the pilot and the faults act, on this grid.
const STEP: Ps = MS;
/// Deeds that a reproduction holds.
const RETOLD: Ps = 30 * SECOND;

#[derive(Clone, Debug)]
pub struct Soak {
    /// The firmware image, with symbols and debug information.
    pub elf: PathBuf,
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
    Deed(#[from] DeedError),
    #[error("the image lacks what the soak watches: {0}")]
    Blind(String),
}

/// How far it got, and what broke first.
#[derive(Clone, Debug)]
pub struct Outcome {
    pub ran: Ps,
    pub tally: Tally,
    pub failure: Option<Failure>,
}

#[derive(Clone, Debug)]
pub struct Failure {
    pub violation: Violation,
    /// A scenario that does again what was done in the last seconds before.
    pub scenario: String,
}

impl Soak {
    /// Runs to the end or to the first rule broken; `watch` hears every simulated second how far it is.
    pub fn run(&self, mut progress: impl FnMut(Ps)) -> Result<Outcome, SoakError> {
        let world = World::new(WorldConfig {
            seed: self.seed,
            ..WorldConfig::default()
        })?;
        let mut machine = Machine::new(&self.elf, world)?;
        machine.set_flash_seed(self.seed);
        machine.set_parameter_flash(&full_sectors::contents());
        let mut watch = Watch::new(&mut machine).map_err(SoakError::Blind)?;
        let mut plan = Plan::new(self.seed, self.length);
        let mut done: Vec<Action> = Vec::new();
        let mut now = 0;
        while now < self.length {
            while let Some(action) = plan.next_until(now) {
                match Simulation::act(&mut machine, &action.what) {
                    // The chip is just booting.
                    Err(DeedError::Machine(FaultError::NotThere { .. })) => continue,
                    // The bus is down for long.
                    Err(DeedError::AdapterFull) => continue,
                    other => other?,
                }
                watch.did(&action);
                done.push(action);
            }
            now += STEP;
            let stopped = machine.run_until(now).err();
            let broken = match stopped {
                Some(why) => Some(Violation {
                    at: now,
                    what: why.to_string(),
                }),
                None => watch.look(&mut machine, now),
            };
            if let Some(violation) = broken {
                let scenario = reproduction::scenario(&done, &violation, self.seed, RETOLD);
                let failure = Some(Failure {
                    violation,
                    scenario,
                });
                return Ok(self.outcome(now, watch, failure));
            }
            if now.is_multiple_of(SECOND) {
                machine.take_log();
                progress(now);
            }
        }
        Ok(self.outcome(now, watch, None))
    }

    fn outcome(&self, ran: Ps, watch: Watch, failure: Option<Failure>) -> Outcome {
        Outcome {
            ran,
            tally: watch.tally(),
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
