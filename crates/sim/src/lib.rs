//! The emulated C board in a simulated world: scenarios on the shipped firmware image, judged, recorded and reported.
//!
//! `c_board` is the board around the chip of `robot-emulator`, `machine` joins both to a firmware image, `pc` says how
//! programs on this computer reach its wires, which `pty` and `gateway` offer, `runner` plays a scenario on the machine, `soak` tests it for hours.

pub mod attitude_score;
pub mod budgets;
mod c_board;
pub mod can_port;
mod course;
pub mod expectation;
pub mod faults;
pub mod gateway;
pub mod image_robot;
pub mod job;
pub mod machine;
pub mod parameter_sectors;
pub mod pc;
mod pty;
mod recording;
mod report;
pub mod run_signals;
pub mod runner;
pub mod scenario;
pub mod signals;
pub mod simulation;
mod skeleton;
pub mod soak;
pub mod summary;
pub mod terminal;
mod trace;
mod tree;
pub mod viewer;
