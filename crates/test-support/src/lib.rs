//! What tests of several crates share: random numbers, rotations, the wires to the simulated world, and Python.
//!
//! Only ever a dev-dependency. Nothing here uses the math of `robot-app`, so tests may check it against this.

#![warn(missing_docs)]

mod python;
mod random;
mod rotation;
mod vector;
#[cfg(feature = "world")]
mod world;

pub use python::Python;
pub use random::Random;
pub use rotation::Rotation;
pub use vector::{Vector, add, cross, dot, norm, scale};
#[cfg(feature = "world")]
pub use world::CanWires;
