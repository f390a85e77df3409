//! The robot as an environment in which a policy learns: the whole app, the simulated world, and a reward.
//!
//! An [`Environment`] is a robot that has been booted and armed in mode PC by the whole app (`robot-host-loop`). A step lasts
//! as long as one run of the network, 20 ms. Its action takes the way of the PC link to the motors, and its observation the
//! way back: both are coded as the link's frames are, and observation and targets are computed by the code that drives the
//! robot itself (`robot-policy`). What only a simulator knows makes the [`reward`] and ends an episode, and is not observed.
//!
//! With the feature `board` the shipped image can run in the emulated board in place of the app ([`Environment::on_board`]).
//!
//! A [`Fleet`] steps many environments in threads. With the feature `python`, which maturin turns on, all of it is the
//! Python package `jiling_gym`.
//!
//! ```
//! use robot_gym::{Environment, Options};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let policies = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../policy");
//! let policy = robot_policy::config::read(&policies, "fivebar", "flat")?;
//! let mut environment = Environment::new(&policy, Options::default(), 7)?;
//! let step = environment.step(&[0.0; 6])?;
//! assert!(step.reward.is_finite() && !step.fallen);
//! assert_eq!(environment.observation().len(), 69);
//! # Ok(())
//! # }
//! ```

#![deny(missing_docs)]

#[cfg(feature = "board")]
mod board;
mod draw;
mod environment;
mod error;
mod fleet;
mod options;
mod power_on;
#[cfg(feature = "python")]
mod python;
pub mod reward;
mod simulated_robot;
mod specimen;
mod truth;
mod wire;

pub use environment::{Environment, Step};
pub use error::GymError;
pub use fleet::{Fleet, Rows};
pub use options::{Options, StartKind};
pub use truth::Truth;
