//! The 1 kHz tick: CAN frames and snapshots in, CAN frames and snapshots out, nothing else.

mod control_loop;
pub mod robot_loop;

pub use control_loop::{ControlInputs, ControlLoop, ControlOutputs, DIAGNOSTICS_PERIOD_TICKS};
