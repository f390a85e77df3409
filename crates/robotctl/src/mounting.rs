//! Finds how board and magnetometer are mounted by tilting the robot (docs/mounting.md).

mod axis;
mod board;
mod mag;
#[cfg(test)]
mod tests;
mod watch;

pub use axis::describe;
pub use board::{BoardError, BoardMounting, Poses, find_board};
pub use mag::{FieldSample, MagError, MagMounting, enough_turned, find_mag};
pub use watch::{Watch, WatchError};
