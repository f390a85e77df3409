//! Finds which control of an SBUS transmitter is on which channel: the pilot moves one after the other
//! (docs/bring-up.md).

mod control;
mod ends;
mod movement;
mod settings;
#[cfg(test)]
mod tests;
mod watch;

pub use control::Control;
pub use ends::stick;
pub use movement::{Frame, MoveError, Moved, Still};
pub use settings::{ENABLE_CHANNEL, Found, differing, write};
pub use watch::{Watch, WatchError};
