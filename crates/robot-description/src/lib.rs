//! One file a robot (`robots/*.toml`): masses, lengths, motors and limits, read and checked.
//!
//! Everything that the firmware, the simulated world and the gains know about a robot comes from its file. All figures
//! are in SI units and radians.
//!
//! Body axes are x forward, y left, z up. Their origin is the hip centre, the middle of the four hip axes.

#![deny(missing_docs)]

mod check;
mod error;
mod figures;
mod fingerprint;
mod five_bar;
mod mass;
mod mjcf;
mod motor;
mod mounting;
mod parts;
mod place;
mod reach;
mod robot;
mod source;
mod stance;
mod urdf;
mod xml;

pub use error::{Located, RobotError};
pub use figures::{Figures, Jump, Stand};
pub use mass::MassSplit;
pub use mjcf::Hold;
pub use motor::JointMotor;
pub use mounting::Mounting;
pub use parts::LINK_RADIUS_M;
pub use place::{path_from, path_of};
pub use reach::Reach;
pub use robot::{
    Body, Bus, Carrier, Control, HipRange, Imu, JointRanges, Joints, Legs, Limits, Link, Robot,
    Weights, Wheels,
};
pub use source::Examined;
