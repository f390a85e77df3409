//! The control stage: high-level command and measurements → actuator commands.
//!
//! Put your own algorithm into `user_controller.rs`. A PC on the link bypasses it: its command goes through `pc_law.rs`.

mod balance;
mod chassis_controller;
mod default_controller;
mod pc_law;
mod pose_hold;
mod standard_controller;
mod user_controller;

pub use balance::{BalanceController, Gains, LegForce, force_of, hip_torques_nm, reaction_nm};
pub use chassis_controller::{ChassisController, ChassisControllerInput, ChassisControllerOutput};
pub use default_controller::DefaultController;
pub use pc_law::pc_law;
pub use standard_controller::StandardController;
pub use user_controller::UserController;
