//! Balancing on two wheels: leg geometry, virtual model, state feedback, support and the states from sitting to jumping.

mod leg;

pub use leg::Leg;
