//! The logic stage: the pilot's switches and sticks, or your own logic → one command, or the choice of the PC, on the
//! logic bus.
//!
//! Put your own logic into `user_logic.rs`.

mod custom_logic;
mod decision;
mod inputs;
mod jump_request;
mod manual;
mod stage;
mod user_logic;

pub use custom_logic::CustomLogic;
pub use decision::LogicDecision;
pub use inputs::LogicInputs;
pub use stage::LogicStage;
pub use user_logic::UserLogic;
