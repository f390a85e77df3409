//! The world around the C board: robot, motors, sensors and radio, each speaking its real wire format.
//!
//! Nothing here knows the chip, and nothing here uses the firmware's codecs: a codec must not be tested against itself.

pub mod time;
pub mod wire;
pub mod world;
