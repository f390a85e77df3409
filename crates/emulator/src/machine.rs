//! CPU, chip, board and world as one deterministic machine.

use std::{collections::BTreeMap, path::Path};

use robot_plant::{time::Ps, world::World};

use crate::board_errors::BoardError;

#[derive(Debug, thiserror::Error)]
pub enum MachineError {
    #[error("cannot load the image: {0}")]
    Image(String),
    /// Unmodelled register, bus fault outside the map, lock-up: the text names register, PC and function.
    #[error("{0}")]
    Stopped(String),
}

/// One line of the firmware's own log.
#[derive(Clone, Debug)]
pub struct LogLine {
    pub at: Ps,
    pub level: String,
    pub text: String,
}

/// Overrides bits in every write the image makes to one register: one wrong line of `board.rs`, for strictness tests.
#[derive(Clone, Copy, Debug)]
pub struct RegisterPatch {
    pub address: u32,
    pub mask: u32,
    pub value: u32,
}

#[derive(Clone, Debug, Default, serde::Serialize)]
pub struct Distribution {
    pub mean: f64,
    pub p50: f64,
    pub p99: f64,
    pub max: f64,
}

/// Measured on the run itself.
#[derive(Clone, Debug, Default, serde::Serialize)]
pub struct Stats {
    pub ticks: u64,
    pub missed: u64,
    pub tick_instructions: Distribution,
    pub release_jitter_us: Distribution,
    /// Counts of release jitter in 0.5 µs bins, for the histogram.
    pub jitter_bins: Vec<u64>,
    /// Busy share of the CPU since the main clock came up, 0 … 1.
    pub cpu_load: f64,
    /// Share of all instructions by context: interrupt name, `thread`.
    pub executors: BTreeMap<String, f64>,
    pub stack_peak_bytes: u64,
    pub resets: Vec<String>,
    pub can: Vec<CanStats>,
}

#[derive(Clone, Debug, Default, serde::Serialize)]
pub struct CanStats {
    /// Frames the board sent.
    pub tx: u64,
    /// Frames the board received.
    pub rx: u64,
    /// Share of time the bus was busy.
    pub load: f64,
    pub errors: u64,
}

pub struct Machine {}

impl Machine {
    /// Powers the board on at time 0 with `elf` in flash.
    pub fn new(_elf: &Path, _world: World) -> Result<Self, MachineError> {
        Ok(Self {})
    }

    pub fn patch_register(&mut self, _patch: RegisterPatch) {}

    pub fn run_until(&mut self, _until: Ps) -> Result<(), MachineError> {
        Ok(())
    }

    pub fn with_world<R>(&mut self, _f: impl FnOnce(&mut World) -> R) -> R {
        unreachable!("filled in by the machine")
    }

    pub fn take_log(&mut self) -> Vec<LogLine> {
        Vec::new()
    }

    /// Names of the firmware's diagnostics, `diag.*`, read from the image's debug information.
    pub fn diag_names(&self) -> &[String] {
        &[]
    }

    /// Present values, in the order of `diag_names`; false while the snapshot cannot be read whole.
    pub fn sample_diag(&mut self, _out: &mut Vec<f64>) -> bool {
        false
    }

    pub fn stats(&self) -> Stats {
        Stats::default()
    }

    pub fn board_errors(&self) -> Vec<BoardError> {
        Vec::new()
    }
}
