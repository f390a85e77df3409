//! A trained network drives the robot: what it sees, what its outputs mean, and the files that say so.
//!
//! A policy is a network with a fixed input and output, run at some 50 Hz. [`PolicyDescription`] says what its values are;
//! it is read from files ([`config`]). [`observation::Observer`] computes the input, and [`action::Decoder`] turns the
//! output into targets of the motors. Neither does any input or output, and neither allocates after it was made.
//!
//! ```
//! use robot_policy::{
//!     action::Decoder,
//!     attitude::QuatWxyz,
//!     config,
//!     observation::{Commands, Observer, Reading},
//! };
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! # let policies = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/vectors/policies");
//! let policy = config::read(&policies, "fivebar", "flat")?;
//! let mut observer = Observer::new(&policy);
//! let mut decoder = Decoder::new(&policy);
//!
//! observer.reset();
//! let mut reading = Reading::at_default_pose(&policy);
//! reading.attitude = QuatWxyz::new([1.0, 0.0, 0.0, 0.0])?;
//! let commands = Commands { forward_mps: 0.5, ..Commands::default() };
//! let input = observer.observe(&reading, &commands, decoder.last_actions())?;
//! assert_eq!(input.len(), observer.layout().len());
//! let output = vec![0.0; policy.joints.len()]; // of the network
//! let targets = decoder.decode(&output)?;
//! assert_eq!(targets.len(), policy.joints.len());
//! # Ok(())
//! # }
//! ```

#![deny(missing_docs)]

pub mod action;
pub mod attitude;
mod base_yaml;
#[cfg(feature = "link")]
pub mod check;
#[cfg(feature = "link")]
pub mod command_source;
pub mod config;
mod description;
#[cfg(feature = "link")]
pub mod fit;
#[cfg(feature = "link")]
pub mod limits;
#[cfg(feature = "link")]
pub mod live;
#[cfg(feature = "runner")]
mod load;
#[cfg(feature = "link")]
pub mod log;
#[cfg(feature = "link")]
pub mod machine;
mod mapping;
#[cfg(feature = "link")]
pub mod messages;
#[cfg(feature = "runner")]
pub mod model;
pub mod observation;
#[cfg(feature = "link")]
pub mod pace;
#[cfg(feature = "link")]
pub mod pages;
pub mod robot;
#[cfg(feature = "link")]
pub mod runner;

pub use base_yaml::{OutOfReach, base_yaml};
pub use description::{
    ActionPlan, Drive, Group, HistoryOrder, Joint, PolicyDescription, Source, TermPlan,
};
#[cfg(feature = "runner")]
pub use load::{LoadError, load};
pub use mapping::{JointMapping, NotAMapping};
