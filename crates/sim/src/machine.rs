//! CPU, chip, board and world as one deterministic machine.

use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
};

use robot_emulator::{
    core::{
        cpu::{Cpu, EngineError, Halt, Pause},
        image::{Image, ImageError},
    },
    soc::{board_errors::BoardError, bus::Soc, reset::ResetCause},
};
use robot_plant::{
    time::{MS, Ps, US, to_seconds},
    world::World,
};

use crate::c_board::CBoard;

pub mod diagnostics;
pub mod faults;
pub mod flash;
mod log;
mod memory;
mod power;
mod probe;
mod rtt;
mod stack;
mod static_record;
mod tick_stats;

use diagnostics::{Diagnostics, LayoutError, meaning::Meaning};
use log::DefmtLog;
use rtt::Rtt;
use stack::StackWatch;
use tick_stats::TickStats;

pub use robot_emulator::soc::bus::RegisterPatch;
pub use static_record::StaticRecord;
pub use tick_stats::Distribution;

/// Symbols that the machine looks up in the image.
const CONTROL_TICK: &str = "robotapp_control_tick";
const RTT_CONTROL_BLOCK: &str = "_SEGGER_RTT";

#[derive(Debug, thiserror::Error)]
pub enum MachineError {
    #[error("cannot load the image: {path}: {source}", path = .path.display())]
    Read {
        path: PathBuf,
        source: std::io::Error,
    },
    #[error("cannot load the image: {0}")]
    Image(#[from] ImageError),
    #[error("cannot load the image: its log cannot be decoded: {0}")]
    Log(String),
    #[error("cannot load the image: its diagnostics cannot be read: {0}")]
    Diagnostics(#[from] LayoutError),
    #[error("the engine refuses the image: {0:?}")]
    Engine(EngineError),
    /// The machine cannot continue: an unmodelled register, a bus fault outside the map, or a lock-up. The text names
    /// register, PC and function.
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

/// Measurements of a run.
#[derive(Clone, Debug, Default, serde::Serialize)]
pub struct Stats {
    pub ticks: u64,
    pub missed: u64,
    pub longest_gap_us: LongestGapUs,
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
    pub flash: FlashUse,
}

/// Longest time from one control tick to the next, by the arming state that the firmware last reported.
#[derive(Clone, Copy, Debug, Default, serde::Serialize)]
pub struct LongestGapUs {
    pub armed: f64,
    pub disarmed: f64,
}

#[derive(Clone, Debug, Default, serde::Serialize)]
pub struct FlashUse {
    pub erases: u64,
    pub programs: u64,
    /// Longest time without a fetch.
    pub longest_stall_us: u64,
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

/// Figures that are cheap to read at any time of a run.
#[derive(Clone, Copy, Debug, Default)]
pub struct Progress {
    /// Control ticks.
    pub missed: u64,
    /// Number of control ticks, and when the last one was entered.
    pub ticks: Option<(u64, Ps)>,
    /// Busy share of the CPU, as in `Stats`.
    pub cpu_load: f64,
    /// How long each CAN bus was busy since power-on.
    pub can_busy: [Ps; 2],
    /// Number of distinct board errors that fail on silicon.
    pub board_errors: usize,
    pub flash_erases: u64,
    pub flash_programs: u64,
}

/// CPU, chip, board and world, with the firmware image that runs on them.
pub struct Machine {
    cpu: Cpu,
    image: Image,
    rtt: Option<Rtt>,
    log: Option<DefmtLog>,
    /// Whether a probe still reads the log.
    log_is_read: bool,
    diagnostics: Diagnostics,
    ticks: TickStats,
    stack: StackWatch,
    /// Deepest stack before the last loss of power.
    stack_peak: u64,
    resets: Vec<String>,
    /// Duration of a power cut at a step of the flash.
    off_time: Ps,
}

/// The log ring is emptied at least this often.
const LOG_POLL: Ps = MS;

impl Machine {
    /// Powers the board on at time 0 with `elf` in flash.
    pub fn new(elf: &Path, world: World) -> Result<Self, MachineError> {
        let bytes = std::fs::read(elf).map_err(|source| MachineError::Read {
            path: elf.to_owned(),
            source,
        })?;
        let image = Image::parse(&bytes)?;
        let cpu = Cpu::new(
            &image.segments,
            image.symbol(CONTROL_TICK),
            Soc::new(Box::new(CBoard::new(world))),
        )
        .map_err(MachineError::Engine)?;
        Ok(Self {
            rtt: image.symbol(RTT_CONTROL_BLOCK).map(Rtt::new),
            log: DefmtLog::new(&bytes)?,
            log_is_read: true,
            diagnostics: Diagnostics::find(&bytes, &image)?,
            stack: StackWatch::of(&image),
            ticks: TickStats::default(),
            stack_peak: 0,
            resets: Vec::new(),
            off_time: power::OFF_TIME,
            cpu,
            image,
        })
    }

    /// The present time.
    pub fn now(&self) -> Ps {
        self.cpu.now()
    }

    pub fn patch_register(&mut self, patch: RegisterPatch) {
        self.cpu.with_soc(|soc, _| soc.add_patch(patch));
    }

    /// Time at which an injected fault last took effect.
    pub fn fault_struck_at(&self) -> Option<Ps> {
        self.cpu.struck_at()
    }

    /// Runs until `until`. The last block of code may end a fraction of a microsecond later.
    pub fn run_until(&mut self, until: Ps) -> Result<(), MachineError> {
        while self.cpu.now() < until {
            let step = until.min((self.cpu.now() / LOG_POLL + 1) * LOG_POLL);
            let pause = self.cpu.run(step);
            self.ticks.follow(self.cpu.stats().entries());
            match pause.map_err(|halt| self.stopped(halt))? {
                Pause::Limit => self.poll_log(),
                Pause::Asleep { thread } => {
                    self.poll_log();
                    if thread {
                        self.diagnostics.copy_from(&self.cpu);
                        self.ticks.set_armed(self.diagnostics.armed());
                    }
                }
                Pause::Reset(ResetCause::PowerOn) => {
                    self.power_off(self.cpu.now() + self.off_time);
                }
                Pause::Reset(cause) => self.reset(cause),
                Pause::PowerReturns => self.power_up(),
            }
        }
        Ok(())
    }

    fn stopped(&self, halt: Halt) -> MachineError {
        let seconds = to_seconds(self.cpu.now());
        let place = self.image.describe(halt.pc);
        MachineError::Stopped(format!("{} at {place}, {seconds:.6} s", halt.what))
    }

    fn reset(&mut self, cause: ResetCause) {
        self.poll_log();
        self.resets.push(format!("{cause:?}"));
        self.diagnostics.forget();
        self.cpu.with_soc(|soc, now| soc.reset(cause, now));
        self.cpu.reset();
        self.ticks.rebooted();
    }

    fn poll_log(&mut self) {
        let (Some(rtt), Some(log), true) = (&self.rtt, &mut self.log, self.log_is_read) else {
            return;
        };
        let mut bytes = Vec::new();
        rtt.drain(&mut self.cpu, &mut bytes);
        log.received(&bytes, self.cpu.now());
    }

    /// Gives access to the world. The chip notices what has changed.
    pub fn with_world<R>(&mut self, f: impl FnOnce(&mut World) -> R) -> R {
        self.with_board(|board| f(&mut board.world))
    }

    fn with_board<R>(&mut self, f: impl FnOnce(&mut CBoard) -> R) -> R {
        self.cpu.with_soc(|soc, _| {
            f(soc
                .board_as()
                .expect("the machine is built around a C board"))
        })
    }

    /// Log lines since the last call.
    pub fn take_log(&mut self) -> Vec<LogLine> {
        self.log.as_mut().map(DefmtLog::take).unwrap_or_default()
    }

    /// Names of the firmware's diagnostics, `diag.*`, read from the image's debug information.
    pub fn diag_names(&self) -> &[String] {
        self.diagnostics.names()
    }

    /// The meaning of the values of each of `diag_names`, where the image tells it.
    pub fn diag_meanings(&self) -> Vec<Option<Meaning>> {
        self.diagnostics.meanings()
    }

    /// Values in the order of `diag_names` as they stood when the thread executor last went to sleep; false while it
    /// has not since boot.
    pub fn sample_diag(&mut self, out: &mut Vec<f64>) -> bool {
        self.diagnostics.sample(out)
    }

    pub fn stats(&self) -> Stats {
        let run = self.cpu.stats();
        Stats {
            ticks: self.ticks.count(),
            missed: self.ticks.missed(),
            longest_gap_us: LongestGapUs {
                armed: self.ticks.longest_gap().armed as f64 / US as f64,
                disarmed: self.ticks.longest_gap().disarmed as f64 / US as f64,
            },
            tick_instructions: self.ticks.instructions(),
            release_jitter_us: self.ticks.release_jitter_us(),
            jitter_bins: self.ticks.jitter_bins(),
            cpu_load: run.cpu_load(),
            executors: run.shares(),
            stack_peak_bytes: self.stack_peak.max(self.stack.peak(&self.cpu)),
            resets: self.resets.clone(),
            can: [0, 1].map(|bus| self.can_stats(bus)).to_vec(),
            flash: self.flash_use(),
        }
    }

    pub fn progress(&self) -> Progress {
        let (run, soc) = (self.cpu.stats(), self.cpu.soc());
        let flash = soc.flash().history().stats();
        Progress {
            missed: self.ticks.missed(),
            ticks: self.ticks.so_far(),
            cpu_load: run.cpu_load(),
            can_busy: [0, 1].map(|bus| soc.can_stats(bus).busy),
            board_errors: soc.errors.list().len(),
            flash_erases: flash.erases,
            flash_programs: flash.programs,
        }
    }

    /// Entry time of the last control tick that has ended.
    pub fn last_tick(&self) -> Option<Ps> {
        self.ticks.last_over(self.cpu.now())
    }

    pub fn resets(&self) -> usize {
        self.resets.len()
    }

    fn flash_use(&self) -> FlashUse {
        let counted = self.cpu.soc().flash().history().stats();
        FlashUse {
            erases: counted.erases,
            programs: counted.programs,
            longest_stall_us: counted.longest_stall / US,
        }
    }

    fn can_stats(&self, bus: usize) -> CanStats {
        let counted = self.cpu.soc().can_stats(bus);
        CanStats {
            tx: counted.tx,
            rx: counted.rx,
            load: counted.busy as f64 / self.cpu.now().max(1) as f64,
            errors: counted.errors,
        }
    }

    /// Board errors that would fail on silicon.
    pub fn board_errors(&self) -> Vec<BoardError> {
        self.cpu.soc().errors.list().to_vec()
    }

    pub fn suspicions(&self) -> Vec<BoardError> {
        self.cpu.soc().errors.suspicions().to_vec()
    }
}
