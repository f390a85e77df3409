//! Sensor corrections found from recorded samples. The firmware applies them (`robot_app::sensing`).

pub mod accel;
mod least_squares;
pub mod mag;
mod parameters;
pub(crate) mod statistics;
