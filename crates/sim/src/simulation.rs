//! The interface between the runner and the emulated board.

use std::io;

use robot_plant::{can_adapter::AdapterMode, time::Ps, world::WireEvent};

use super::{
    faults::{self, EventError},
    scenario::Event,
};
use crate::{
    machine::{LogLine, Machine, MachineError, Progress, Stats, diagnostics::meaning::Meaning},
    pc::PcPorts,
};
use robot_emulator::soc::board_errors::BoardError;

/// A board with a world around it that advances in simulated time.
pub trait Simulation {
    fn run_until(&mut self, until: Ps) -> Result<(), MachineError>;
    fn apply(&mut self, event: &Event) -> Result<(), EventError>;
    /// Exchanges frames and bytes between the world and the programs on `ports`.
    fn serve(&mut self, ports: &mut PcPorts) -> io::Result<()>;
    fn world_names(&mut self) -> Vec<String>;
    fn sample_world(&mut self, out: &mut Vec<f64>);
    fn drain_wire_events(&mut self, out: &mut Vec<WireEvent>);
    fn diag_names(&mut self) -> Vec<String>;
    /// The meaning of the values of each of them, if the firmware contains it.
    fn diag_meanings(&mut self) -> Vec<Option<Meaning>>;
    /// Returns false while the firmware's diagnostics cannot be read consistently.
    fn sample_diag(&mut self, out: &mut Vec<f64>) -> bool;
    /// Total, heading and inclination error of the last tick's estimate in degrees; `None` in a gap of the reference.
    fn attitude_error_deg(&mut self, q_wxyz: [f64; 4]) -> Option<[f64; 3]>;
    fn take_log(&mut self) -> Vec<LogLine>;
    /// All measurements. This takes some time for a long run.
    fn stats(&mut self) -> Stats;
    fn progress(&mut self) -> Progress;
    /// Resets since power-on.
    fn resets(&mut self) -> usize;
    /// Errors that fail on silicon.
    fn board_errors(&mut self) -> Vec<BoardError>;
    fn suspicions(&mut self) -> Vec<BoardError>;
}

impl Simulation for Machine {
    fn run_until(&mut self, until: Ps) -> Result<(), MachineError> {
        Machine::run_until(self, until)
    }

    fn apply(&mut self, event: &Event) -> Result<(), EventError> {
        match event {
            Event::Remote(input) => {
                self.with_world(|world| world.set_remote(*input));
                Ok(())
            }
            Event::Pc(input) => {
                self.with_world(|world| world.set_pc(*input));
                Ok(())
            }
            Event::Can(bus, frame) => {
                let taken = self.with_world(|world| {
                    let adapter = world.can_adapter(*bus);
                    if adapter.mode() != AdapterMode::Active {
                        adapter.set_mode(AdapterMode::Active);
                    }
                    adapter.send(*frame)
                });
                taken.then_some(()).ok_or(EventError::AdapterFull)
            }
            Event::Push(push) => {
                self.with_world(|world| world.push(*push));
                Ok(())
            }
            Event::StartFault(name) => faults::set(self, name, true),
            Event::EndFault(name) => faults::set(self, name, false),
        }
    }

    fn serve(&mut self, ports: &mut PcPorts) -> io::Result<()> {
        if ports.is_empty() {
            return Ok(());
        }
        let now = self.now();
        self.with_world(|world| ports.serve(world, now))
    }

    fn world_names(&mut self) -> Vec<String> {
        self.with_world(|world| world.signal_names().to_vec())
    }

    fn sample_world(&mut self, out: &mut Vec<f64>) {
        self.with_world(|world| world.sample(out));
    }

    fn drain_wire_events(&mut self, out: &mut Vec<WireEvent>) {
        self.with_world(|world| world.drain_wire_events(out));
    }

    fn diag_names(&mut self) -> Vec<String> {
        Machine::diag_names(self).to_vec()
    }

    fn diag_meanings(&mut self) -> Vec<Option<Meaning>> {
        Machine::diag_meanings(self)
    }

    fn sample_diag(&mut self, out: &mut Vec<f64>) -> bool {
        Machine::sample_diag(self, out)
    }

    fn attitude_error_deg(&mut self, q_wxyz: [f64; 4]) -> Option<[f64; 3]> {
        let estimated_at = self.last_tick()?;
        self.with_world(|world| world.past_attitude_error_deg(q_wxyz, estimated_at))
    }

    fn take_log(&mut self) -> Vec<LogLine> {
        Machine::take_log(self)
    }

    fn stats(&mut self) -> Stats {
        Machine::stats(self)
    }

    fn progress(&mut self) -> Progress {
        Machine::progress(self)
    }

    fn resets(&mut self) -> usize {
        Machine::resets(self)
    }

    fn board_errors(&mut self) -> Vec<BoardError> {
        Machine::board_errors(self)
    }

    fn suspicions(&mut self) -> Vec<BoardError> {
        Machine::suspicions(self)
    }
}
