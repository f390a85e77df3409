//! Geometry of legs and wheels, for estimation and control.

mod leg;

pub use leg::Leg;
