//! The control stage: high-level command and measurements → actuator commands.
//!
//! Put your own algorithm into `user_controller.rs`.

mod chassis_controller;
mod default_controller;
mod pose_hold;
mod user_controller;

pub use chassis_controller::{ChassisController, ChassisControllerInput, ChassisControllerOutput};
pub use default_controller::DefaultController;
pub use user_controller::UserController;
