//! Bring-up of new hardware in three steps: read only, zero torque, a little torque on one motor (测试安全性).
//!
//! Started from the radio or the tuning channel, ended by an off request or a reboot. It only replaces the command: for
//! torque the robot must be armed and permitted to move as ever.

mod joint_watch;
mod limits;
mod radio_gesture;
mod radio_selection;
mod request;
mod session;
mod status;
mod trial;

pub use joint_watch::{JointReading, JointWatch, Turn};
pub use request::{BringUpRequest, TestMotor, Trial, TrialAction};
pub use session::{BringUp, BringUpInputs};
pub use status::{BringUpStatus, BringUpStep, TrialState};
