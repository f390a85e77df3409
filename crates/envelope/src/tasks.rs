//! The tasks, with what is wanted of each.

mod drive;
mod fall;
mod jump;
mod push;
mod sit_down;
mod stand;
mod stand_up;
mod terrain;

use crate::{
    Robots,
    limit::Bisection,
    trial::{Failure, Trial},
};

/// On which side of its limit a figure must lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bound {
    /// It must be at most the limit.
    AtMost,
    /// It must be at least the limit.
    AtLeast,
}

/// The outcome of one run, before it is compared with the limit.
pub(crate) struct Finished {
    /// The figure of the task, or why there is none.
    pub figure: Result<f64, Failure>,
    pub trial: Trial,
}

impl Finished {
    /// Runs `act`, which judges the trial.
    pub fn by(mut trial: Trial, act: impl FnOnce(&mut Trial) -> Result<f64, Failure>) -> Self {
        let figure = act(&mut trial);
        Self { figure, trial }
    }

    /// The same with a robot that has stood up.
    pub fn standing(
        started: Result<Trial, Box<(Failure, Trial)>>,
        act: impl FnOnce(&mut Trial) -> Result<f64, Failure>,
    ) -> Self {
        match started {
            Ok(trial) => Self::by(trial, act),
            Err(fallen) => {
                let (failure, trial) = *fallen;
                Self {
                    figure: Err(failure),
                    trial,
                }
            }
        }
    }
}

/// Something that the robot shall do.
pub struct Task {
    /// Its name on the command line and in `envelope.json`.
    pub name: &'static str,
    /// What is done, in a few words.
    pub what: &'static str,
    /// The figure that a run gives.
    pub figure: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// Its limit.
    pub limit: f64,
    /// On which side it must lie.
    pub bound: Bound,
    /// Rate of runs that must succeed.
    pub wanted: f64,
    pub(crate) run: fn(&Robots, u64) -> Finished,
    /// What is made stronger until half of the robots fall.
    pub(crate) bisection: Option<&'static Bisection>,
}

/// Every task.
pub const TASKS: &[Task] = &[
    stand::STAND,
    drive::DRIVE,
    drive::SPIN,
    push::PUSH,
    push::PUSH_DIAGONAL,
    terrain::SLOPE,
    terrain::RAMP,
    terrain::STEP_DOWN,
    terrain::STEP_UP,
    terrain::DROP,
    jump::JUMP,
    stand_up::SITTING,
    stand_up::FOLDED,
    stand_up::FRONT,
    stand_up::BACK,
    stand_up::LEFT,
    stand_up::RIGHT,
    stand_up::UPSIDE_DOWN,
    sit_down::SIT_DOWN,
    fall::LOST,
];
