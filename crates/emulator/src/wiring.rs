//! The C board's schematic: which pin of the chip goes to which device (RoboMaster Development Board C, user manual and
//! schematic).

mod nets;
mod outputs;
mod signals;

pub use nets::{connect, drive_inputs, drives_input};
pub use outputs::{Outputs, PwmTimers, check_mag_reset};
pub use signals::{Signal, check, check_speed};
