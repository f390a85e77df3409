//! Bring-up of new hardware in three steps (测试安全性): read only, zero torque, and a little torque on one motor.
//!
//! It is started from the radio or the tuning channel and ends with an off request or a reboot. It only replaces the
//! command: torque still needs an armed robot and a permit.

mod joint_motion_monitor;
mod limits;
mod radio_gesture;
mod radio_selection;
mod request;
mod session;
mod status;
mod trial;

pub use joint_motion_monitor::{JointMotionMonitor, JointReading, Turn};
pub use request::{BringUpRequest, TestMotor, Trial, TrialAction};
pub use session::{BringUp, BringUpInputs};
pub use status::{BringUpStatus, BringUpStep, TrialState};
