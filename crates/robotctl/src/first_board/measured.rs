//! Measurements that the tool takes from the robot's live pages.

mod board;
mod compass;
mod motors;
mod radio;
mod sensors;
mod verdict;

pub use board::{battery, boot, erase, heater, jitter, watchdog};
pub use compass::circle;
pub use motors::{joints_answer, wheels_heard};
pub use radio::{radio, radio_off};
pub use sensors::{after_an_hour, flat, left_turn, left_up, nose_up, upside_down};
pub use verdict::{MeasureFn, Measured, Verdict};
