//! What the runner needs of an emulated board.

use robot_plant::{
    time::Ps,
    world::{WireEvent, WorldError},
};

use super::scenario::Deed;
use crate::{
    board_errors::BoardError,
    machine::{LogLine, Machine, MachineError, Stats},
};

/// A board with a world around it that advances in simulated time.
pub trait Board {
    fn run_until(&mut self, until: Ps) -> Result<(), MachineError>;
    fn act(&mut self, deed: &Deed) -> Result<(), WorldError>;
    fn world_names(&mut self) -> Vec<String>;
    fn sample_world(&mut self, out: &mut Vec<f64>);
    fn drain_wire_events(&mut self, out: &mut Vec<WireEvent>);
    fn diag_names(&mut self) -> Vec<String>;
    /// False while the firmware's diagnostics cannot be read whole.
    fn sample_diag(&mut self, out: &mut Vec<f64>) -> bool;
    /// Total, heading and inclination error in degrees; `None` in a gap of the reference.
    fn attitude_error_deg(&mut self, q_wxyz: [f64; 4]) -> Option<[f64; 3]>;
    fn take_log(&mut self) -> Vec<LogLine>;
    fn stats(&mut self) -> Stats;
    fn board_errors(&mut self) -> Vec<BoardError>;
}

impl Board for Machine {
    fn run_until(&mut self, until: Ps) -> Result<(), MachineError> {
        Machine::run_until(self, until)
    }

    fn act(&mut self, deed: &Deed) -> Result<(), WorldError> {
        self.with_world(|world| match deed {
            Deed::Remote(input) => {
                world.set_remote(*input);
                Ok(())
            }
            Deed::StartFault(name) => world.set_fault(name, true),
            Deed::EndFault(name) => world.set_fault(name, false),
        })
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

    fn sample_diag(&mut self, out: &mut Vec<f64>) -> bool {
        Machine::sample_diag(self, out)
    }

    fn attitude_error_deg(&mut self, q_wxyz: [f64; 4]) -> Option<[f64; 3]> {
        self.with_world(|world| world.attitude_error_deg(q_wxyz))
    }

    fn take_log(&mut self) -> Vec<LogLine> {
        Machine::take_log(self)
    }

    fn stats(&mut self) -> Stats {
        Machine::stats(self)
    }

    fn board_errors(&mut self) -> Vec<BoardError> {
        Machine::board_errors(self)
    }
}
