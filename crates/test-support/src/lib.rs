//! What tests of several crates share: random numbers, rotations, and the wires to the simulated world.
//!
//! Only ever a dev-dependency. Nothing here uses the math of `robot-app`, so tests may check it against this.

#![warn(missing_docs)]

mod random;
mod rotation;
mod vector;
#[cfg(feature = "world")]
mod world;

pub use random::Random;
pub use rotation::Rotation;
pub use vector::{Vector, add, cross, dot, norm, scale};
#[cfg(feature = "world")]
pub use world::CanWires;
