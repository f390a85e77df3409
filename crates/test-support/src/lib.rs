//! What tests of several crates share: random numbers, rotations, the wires to the simulated world, frames of a
//! gateway, Python, the firmware's image, and how much of a long test runs.
//!
//! Only ever a dev-dependency. Nothing here uses the math of `robot-app`, so tests may check it against this.

#![warn(missing_docs)]

mod can_to_eth;
mod image;
mod python;
mod random;
mod rotation;
mod vector;
mod whole;
#[cfg(feature = "world")]
mod world;

pub use can_to_eth::CanToEth;
pub use image::{image, repository};
pub use python::Python;
pub use random::Random;
pub use rotation::Rotation;
pub use vector::{Vector, add, cross, dot, norm, scale};
pub use whole::is_whole;
#[cfg(feature = "world")]
pub use world::CanWires;
