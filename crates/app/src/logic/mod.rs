//! What the pilot means: remote → command on the logic bus.

mod bus;
mod stage;

pub use bus::LogicBus;
pub use stage::LogicStage;
