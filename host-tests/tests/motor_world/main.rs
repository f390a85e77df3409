//! The motors' side of the tick with simulated drives, which are written from the datasheets alone.

mod faults;
mod flash;
mod limits;
mod motion;
mod robot;
mod set_up;
