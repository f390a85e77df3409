//! A scenario: robot and radio, the actions of the pilot and the faults over time, and what must hold.

mod file;

pub use file::Problem;

use std::{
    path::{Path, PathBuf},
    sync::Arc,
};

use robot_description::Robot;
use robot_plant::{
    mounting::Mounting,
    time::Ps,
    wire::CanFrame,
    world::{
        CanBusId, PcInput, PlantKind, Push, RadioKind, RemoteInput, Start, Terrain, Variation,
    },
};

use super::expectation::Expectation;
use crate::{machine::flash::FlashTimes, parameter_sectors::Record};

/// A valid scenario. Every time lies inside the run, every fault exists, and every expectation has a window and a bound.
#[derive(Clone, Debug)]
pub struct Scenario {
    pub name: String,
    /// Length of the run.
    pub length: Ps,
    pub plant: PlantKind,
    /// How the free robot lies or stands at power-on.
    pub start: Start,
    /// The ground under the free robot.
    pub terrain: Terrain,
    pub radio: RadioKind,
    /// Its motors, the board's place, and the masses of the free robot.
    pub robot: Arc<Robot>,
    pub robot_choice: RobotChoice,
    /// How the free robot differs from its file.
    pub variation: Variation,
    /// CAN time-out that is set in the RS00 drives; 0 = off.
    pub rs00_timeout: Ps,
    /// Temperature of the IMU's package at power-on, °C; `None` for a board that has been on before.
    pub imu_temperature_c: Option<f64>,
    /// Orientation of the board in the robot; `None` for that of the robot's file.
    pub mounting: Option<Mounting>,
    /// Orientation of the magnetometer against the IMU.
    pub mag_mounting: Mounting,
    pub seed: u64,
    pub flash: FlashSetup,
    /// Sorted by time; events of the same time keep their order in the file.
    pub events: Vec<TimedEvent>,
    pub expectations: Vec<Expectation>,
    /// Board errors whose message contains one of these do not fail the run.
    pub allow_board_errors: Vec<String>,
}

/// How a scenario says which robot it is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RobotChoice {
    /// Not at all: it is the one that the image is for.
    #[default]
    OfTheImage,
    /// By its file.
    Named,
    /// By the make of its joints, which may be others than those that the image is for.
    OtherJoints,
}

/// The parameter sectors at power-on.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FlashSetup {
    pub contents: FlashContents,
    pub times: FlashTimes,
    /// Seed of the contents of torn words and sectors; `None` for the scenario's own.
    pub seed: Option<u64>,
}

#[derive(Clone, Debug, Default, PartialEq)]
pub enum FlashContents {
    #[default]
    Erased,
    /// The contents of a file of 48 KiB.
    Image(PathBuf),
    /// Records that an earlier run saved.
    Records(Vec<Record>),
}

/// Something that happens to the robot at a certain time.
#[derive(Clone, Debug, PartialEq)]
pub struct TimedEvent {
    pub at: Ps,
    pub event: Event,
}

#[derive(Clone, Debug, PartialEq)]
pub enum Event {
    /// The pilot moves sticks or switches.
    Remote(RemoteInput),
    /// The program on the PC sends something else over the serial link.
    Pc(PcInput),
    /// The PC's adapter sends a frame.
    Can(CanBusId, CanFrame),
    /// Somebody pushes the free robot.
    Push(Push),
    StartFault(String),
    EndFault(String),
}

/// A scenario file cannot be read, or something in it is wrong.
#[derive(Debug, thiserror::Error)]
pub enum ScenarioError {
    #[error("cannot read the scenario {path}: {source}")]
    Read {
        path: PathBuf,
        source: std::io::Error,
    },
    #[error("{file}:{line}: {problem}")]
    Wrong {
        file: String,
        line: usize,
        problem: Problem,
    },
}

impl Scenario {
    pub fn read(path: &Path) -> Result<Self, ScenarioError> {
        let text = std::fs::read_to_string(path).map_err(|source| ScenarioError::Read {
            path: path.to_owned(),
            source,
        })?;
        Self::parse(&text, &path.display().to_string())
    }

    /// Whether a simulated program on the PC sends commands over the serial link.
    pub fn has_pc(&self) -> bool {
        let mut events = self.events.iter();
        events.any(|timed| matches!(timed.event, Event::Pc(_)))
    }

    /// Cuts the run to `length`. Returns the number of expectations that are dropped because they reach beyond it.
    pub fn cut_to(&mut self, length: Ps) -> usize {
        let before = self.expectations.len();
        self.length = length;
        self.expectations.retain(|e| e.window.end <= length);
        before - self.expectations.len()
    }

    /// Parses the text of a scenario; `file` names it in errors.
    pub fn parse(text: &str, file: &str) -> Result<Self, ScenarioError> {
        file::parse(text, file)
    }
}
