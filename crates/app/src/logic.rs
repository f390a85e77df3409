//! The logic stage: commands of the pilot, a PC or your own logic → one command on the logic bus.
//!
//! Put your own logic into `user_logic.rs`.

mod custom_logic;
mod decision;
mod inputs;
mod manual;
mod pc_command;
mod stage;
mod user_logic;

pub use custom_logic::CustomLogic;
pub use decision::LogicDecision;
pub use inputs::LogicInputs;
pub use pc_command::PcCommand;
pub use stage::LogicStage;
pub use user_logic::UserLogic;
