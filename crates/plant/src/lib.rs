//! The world around the C board: robot, motors, sensors and radio, each speaking its real wire format.
//!
//! The chip itself is not here, except for its flash cells, which keep their contents without power. Nothing here uses the
//! firmware's codecs: a codec must not be tested against itself.

#![deny(missing_docs)]

pub mod attitude;
pub mod can_adapter;
pub mod complaint;
pub mod flash_chip;
pub mod mounting;
pub mod recording;
pub mod robots;
pub mod serial_adapter;
pub mod wire;
pub mod world;

mod bmi088;
mod body;
mod faults;
mod ist8310;
mod joints;
mod m3508;
mod motion;
mod pc;
mod physics;
mod radio;
mod random;
mod supply;

pub use body::free;
pub use pc::link_frames;
pub use robot_wire::time;
