//! The 1 kHz tick: CAN frames and snapshots in, CAN frames and snapshots out.

mod control_loop;
mod inputs;
mod outputs;
mod robot_loop;
mod state;

pub use control_loop::{ControlLoop, DIAGNOSTICS_PERIOD_TICKS};
pub use inputs::ControlInputs;
pub use outputs::ControlOutputs;
pub use robot_loop::RobotLoop;
use state::TickState;
