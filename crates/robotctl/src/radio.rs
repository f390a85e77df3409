//! Finds which control of an SBUS transmitter is on which channel: the pilot moves one after the other
//! (docs/bring-up.md).

mod control;
mod ends;
mod mapped_control;
mod movement;
mod settings;
#[cfg(test)]
mod tests;
mod watch;

pub use control::Control;
pub use ends::stick;
pub use mapped_control::MappedControl;
pub use movement::{Frame, HeldPosition, MoveError, Movement};
pub use settings::{ENABLE_CHANNEL, differing, write};
pub use watch::{Watch, WatchError};
