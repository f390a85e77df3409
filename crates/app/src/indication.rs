//! The indication stage: state → LED and buzzer. `docs/indications.md` has the table for the pilot.

mod patterns;
mod player;
mod selection;

pub use patterns::Colour;
pub use player::{IndicationPlayer, Signal};
pub use selection::{Indication, IndicationInputs};
