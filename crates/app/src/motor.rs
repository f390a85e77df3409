//! The motor stage: motors on the CAN buses.
//!
//! | file | contents |
//! |---|---|
//! | `layout` | which motor sits where; the compiler checks bus load and identifiers |
//! | `m3508`, `dm4310`, `rs00`, `mit`, `setpoint` | frames ↔ values |
//! | `interface` | the trait by which the manager knows a motor |
//! | `wheel`, `joint` | one motor each: set-up, enabling, faults, frozen reports |
//! | `joint_limits` | limits of joint commands |
//! | `manager` | all motors: feedback in, command frames out |

mod angle_monitor;
pub mod dm4310;
mod interface;
mod joint;
mod joint_limits;
pub mod layout;
pub mod m3508;
mod manager;
pub mod mit;
pub mod rs00;
mod setpoint;
mod wheel;

pub use joint::NotStationary;
pub(crate) use manager::{MotorManager, TickFrames};
