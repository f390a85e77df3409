//! Where is up, where is north, how fast: IMU, magnetometer and wheels → `StateEstimate`.
//!
//! `docs/estimator.md` has the equations and where each comes from.

mod attitude;
mod ins_estimator;
mod magnetic;
mod motion;
#[cfg(test)]
pub(crate) mod testing;

pub use ins_estimator::{Field, InsEstimator};
