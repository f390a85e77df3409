//! Named faults of the board itself: failures of the program, which a reset ends, of the flash and of the supply, and the
//! effects of a debug probe.

use robot_plant::{time::MS, world::FaultInfo};

use super::{CONTROL_TICK, Machine};
use robot_emulator::core::{
    cpu::{Cpu, Effect, Injection},
    image::Image,
};

#[derive(Debug, thiserror::Error)]
pub enum FaultError {
    #[error("no fault is named `{0}`; `cargo xtask sim --list-faults` lists them")]
    Unknown(String),
    #[error("the fault `{fault}` needs {what}, which is not in the image or not running")]
    NotThere { fault: &'static str, what: String },
}

/// The place at which a fault takes effect.
#[derive(Clone, Copy, Debug)]
enum Place {
    ControlTick,
    /// The function through which the executor runs the task of `src/tasks/`.
    Task(&'static str),
}

#[derive(Clone, Copy, Debug)]
enum Failure {
    Panic,
    HardFault,
    StackOverflow,
    Stuck,
    Asleep,
}

#[derive(Clone, Copy, Debug)]
enum Kind {
    /// The program fails there.
    Program(Place, Failure),
    PowerCut,
    FlashStuckBits,
    FlashEraseFails,
    ProbeAttached,
    ProbeInsists,
    ProbeBreakpoints,
    /// A probe halts the core for that many ms.
    ProbeHalts(u64),
}

struct Entry {
    info: FaultInfo,
    kind: Kind,
}

const fn entry(name: &'static str, place: Place, failure: Failure, what: &'static str) -> Entry {
    board(name, Kind::Program(place, failure), what)
}

const fn board(name: &'static str, kind: Kind, what: &'static str) -> Entry {
    Entry {
        info: FaultInfo { name, what },
        kind,
    }
}

#[rustfmt::skip]
const ENTRIES: &[Entry] = &[
    entry("panic", Place::ControlTick, Failure::Panic, "the next control tick panics"),
    entry("panic-thread", Place::Task("logic"), Failure::Panic, "the logic task panics, below every interrupt"),
    entry("hard-fault", Place::ControlTick, Failure::HardFault, "the next control tick runs into an undefined instruction"),
    entry("stack-overflow", Place::ControlTick, Failure::StackOverflow, "the next control tick finds its stack used up"),
    entry("task-stuck-control", Place::ControlTick, Failure::Stuck, "the next control tick does not return"),
    entry("task-stuck-sensor", Place::Task("imu"), Failure::Stuck, "the imu task does not return: no sensor, no radio"),
    entry("task-stuck-thread", Place::Task("logic"), Failure::Stuck, "the logic task does not return: no task in thread mode"),
    entry("task-asleep-imu", Place::Task("imu"), Failure::Asleep, "the imu task is never run, all others are"),
    entry("task-asleep-mag", Place::Task("mag"), Failure::Asleep, "the mag task is never run, all others are"),
    entry("task-asleep-sbus", Place::Task("sbus"), Failure::Asleep, "the sbus task is never run, all others are"),
    entry("task-asleep-logic", Place::Task("logic"), Failure::Asleep, "the logic task is never run, all others are"),
    entry("task-asleep-status", Place::Task("status"), Failure::Asleep, "the status task is never run, all others are"),
    entry("task-asleep-params", Place::Task("params"), Failure::Asleep, "the params task is never run, all others are"),
    entry("task-asleep-link-receive", Place::Task("link_receive"), Failure::Asleep, "the link receive task is never run, all others are"),
    entry("task-asleep-link-send", Place::Task("link_send"), Failure::Asleep, "the link send task is never run, all others are"),
    board("power-cut", Kind::PowerCut, "the board and its sensors have no power; motors, radio and PC have; then it boots"),
    board("flash-stuck-bits", Kind::FlashStuckBits, "one bit in every word of the parameter sectors is stuck at 1"),
    board("flash-erase-fails", Kind::FlashEraseFails, "erasing a parameter sector takes its time and does nothing"),
    board("probe-attached", Kind::ProbeAttached, "a debug probe catches reset and hard fault, as probe-rs does by default; what it sets stays until the power goes, but nobody reads the log"),
    board("probe-insists", Kind::ProbeInsists, "a debugger catches reset and hard fault, and again as soon as that is cleared"),
    board("probe-breakpoints", Kind::ProbeBreakpoints, "a debugger leaves breakpoints where the program fails, and watchdogs that wait for it"),
    board("probe-halts-5ms", Kind::ProbeHalts(5), "a debug probe halts the core for 5 ms"),
    board("probe-halts-20ms", Kind::ProbeHalts(20), "a debug probe halts the core for 20 ms"),
    board("probe-halts-100ms", Kind::ProbeHalts(100), "a debug probe halts the core for 100 ms"),
];

/// All faults of the machine.
pub fn all() -> impl Iterator<Item = &'static FaultInfo> {
    ENTRIES.iter().map(|entry| &entry.info)
}

/// The faults after which the program no longer does its work, until a reset.
pub fn of_the_program() -> impl Iterator<Item = &'static FaultInfo> {
    let failures = ENTRIES.iter();
    let failures = failures.filter(|entry| matches!(entry.kind, Kind::Program(..)));
    failures.map(|entry| &entry.info)
}

impl Machine {
    /// Starts or ends one of [`all`]. The end of a fault that has taken effect changes nothing, except that a stuck task
    /// continues and a debugger no longer sets its catches again.
    pub fn set_fault(&mut self, name: &str, active: bool) -> Result<(), FaultError> {
        let entry = ENTRIES
            .iter()
            .find(|entry| entry.info.name == name)
            .ok_or_else(|| FaultError::Unknown(name.to_owned()))?;
        match entry.kind {
            Kind::Program(place, failure) => {
                let injection = entry.inject(place, failure, &self.image, &self.cpu)?;
                if active {
                    self.cpu.inject(injection);
                } else {
                    self.cpu.end_injection(injection);
                }
            }
            Kind::PowerCut => self.switch_power(!active),
            Kind::FlashStuckBits => self.set_worn_words(active),
            Kind::FlashEraseFails => self.set_erases_fail(active),
            Kind::ProbeInsists => self.keep_catches_set(active),
            Kind::ProbeAttached if active => self.attach_probe(),
            Kind::ProbeBreakpoints if active => self.leave_breakpoints(),
            Kind::ProbeHalts(ms) if active => self.halt_core(ms * MS),
            Kind::ProbeAttached => self.pull_probe(),
            // These stay in the core when the probe is detached.
            Kind::ProbeBreakpoints | Kind::ProbeHalts(_) => {}
        }
        Ok(())
    }
}

impl Entry {
    fn inject(
        &self,
        place: Place,
        failure: Failure,
        image: &Image,
        cpu: &Cpu,
    ) -> Result<Injection, FaultError> {
        let symbol = |name: &str| self.present(image.symbol(name), name);
        Ok(Injection {
            entry: match place {
                Place::ControlTick => symbol(CONTROL_TICK)?,
                Place::Task(task) => {
                    let poll = poll_function(image, cpu, task);
                    self.present(poll, &format!("task {task}, spawned"))?
                }
            },
            effect: match failure {
                Failure::Panic => Effect::GoTo(symbol("_defmt_panic")?),
                Failure::HardFault => Effect::Undefined,
                Failure::StackOverflow => Effect::StackAt(symbol("_stack_end")?),
                Failure::Stuck => Effect::Hang,
                Failure::Asleep => Effect::ReturnAtOnce,
            },
        })
    }

    fn present(&self, address: Option<u32>, what: &str) -> Result<u32, FaultError> {
        address.ok_or_else(|| FaultError::NotThere {
            fault: self.info.name,
            what: what.to_owned(),
        })
    }
}

/// Embassy runs a task by calling `TaskStorage<its future>::poll`. Symbol names do not always tell the instances apart,
/// but the task's storage holds the address of its own from the spawn on.
fn poll_function(image: &Image, cpu: &Cpu, task: &str) -> Option<u32> {
    let (pool, size) = image.static_item(&format!("::tasks::{task}::run::POOL"))?;
    let mut storage = vec![0; size as usize];
    if !cpu.read_memory(pool, &mut storage) {
        return None;
    }
    let candidates: Vec<u32> = image.functions("TaskStorage<", "::poll").collect();
    storage
        .chunks_exact(4)
        .map(|word| u32::from_le_bytes([word[0], word[1], word[2], word[3]]) & !1)
        .find(|word| candidates.contains(word))
}
