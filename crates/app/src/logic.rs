//! What shall be done: remote, PC or the user's own logic → command on the logic bus.
//!
//! To write your own logic, edit `user_logic.rs`.

mod bus;
mod custom_logic;
mod decision;
mod inputs;
mod manual;
mod pc_command;
mod stage;
mod user_logic;

pub use bus::LogicBus;
pub use custom_logic::CustomLogic;
pub use decision::LogicDecision;
pub use inputs::LogicInputs;
pub use pc_command::PcCommand;
pub use stage::LogicStage;
pub use user_logic::UserLogic;
