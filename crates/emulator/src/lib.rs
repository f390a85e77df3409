//! An emulated RoboMaster C board: the shipped firmware image boots here, unchanged.
//!
//! `core` runs the Cortex-M4F, `soc` holds the STM32F407's peripherals, `wiring` is the board's schematic,
//! `machine` joins them to the world of `robot-plant`, `pty` offers its CAN buses to tools on this computer,
//! `sim` runs scenarios on the machine, `soak` keeps it busy for hours.

pub mod board_errors;
pub mod core;
pub mod machine;
pub mod parameter_sectors;
mod pty;
pub mod sim;
pub mod soak;
mod soc;
mod wiring;
