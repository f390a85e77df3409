//! Finds how board and magnetometer are mounted by tilting the robot (docs/mounting.md).

mod board;
mod mag;
#[cfg(test)]
mod tests;
mod watch;
mod words;

pub use board::{BoardError, BoardFound, Poses, find_board};
pub use mag::{FieldSample, MagError, MagFound, enough_turned, find_mag};
pub use watch::{Watch, WatchError};
pub use words::describe;
