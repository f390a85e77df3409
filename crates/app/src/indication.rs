//! What the robot tells people who see and hear it: state → LED and buzzer. The table for people is `docs/indications.md`.

mod choice;
mod patterns;
mod player;

pub use choice::{Indication, IndicationInputs};
pub use patterns::Colour;
pub use player::{IndicationPlayer, Signal};
