//! Motors on the CAN buses.

mod bus_budget;
pub mod m3508;
mod manager;
mod safe_frames;

pub(crate) use manager::{MotorManager, WHEEL_BUS};
pub use safe_frames::safe_frames;
