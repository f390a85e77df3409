//! Runs the firmware's estimator over recorded motion, and compares its attitude with the reference.
//!
//! ```no_run
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! use robot_replay::{At, Mode, load, run};
//! for trial in load("../shared/data/broad".as_ref())? {
//!     let run = run(&trial, Mode::NineAxis, [0.0; 3]);
//!     println!("{}: {:?}", trial.name, run.score(&trial, At::EveryTick));
//! }
//! # Ok(())
//! # }
//! ```

pub mod broad;
mod reference;
mod resample;
mod run;
mod score;
mod track;
mod trial;

pub use resample::{FIELD_AGE_US, Motion, Sample};
pub use run::{Mode, Run, Tick, run};
pub use score::{At, Figures, Instant};
pub use trial::{ReplayError, Trial, load, trial_files};
