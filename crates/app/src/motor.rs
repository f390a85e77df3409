//! Motors on the CAN buses.
//!
//! | file | what |
//! |---|---|
//! | `layout` | which motor sits where; load and identifiers checked by the compiler |
//! | `m3508`, `dm4310`, `rs00`, `mit`, `set_point` | frames ↔ values |
//! | `interface` | what every motor is to the manager |
//! | `wheel`, `joint` | one motor each: set-up, enabling, faults, frozen reports |
//! | `joint_limits` | what a joint may be asked for |
//! | `manager` | all of them: feedback in, frames out |

mod angle_watch;
pub mod dm4310;
mod interface;
mod joint;
mod joint_limits;
pub mod layout;
pub mod m3508;
mod manager;
pub mod mit;
pub mod rs00;
mod set_point;
mod wheel;

pub use joint::NotStanding;
pub(crate) use manager::{MotorManager, TickFrames};
