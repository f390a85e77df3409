//! Attitude, heading, velocity and position: IMU, magnetometer and wheels → `StateEstimate`.
//!
//! [`InsEstimator`] is all that the other stages see. `docs/estimator.md` and `docs/motion-estimate.md` have the equations
//! and their sources.

mod attitude;
mod attitude_variance;
mod ins_estimator;
mod magnetic;
mod measurement;
mod motion;
mod strapdown;

pub use ins_estimator::{HeadingSource, InsEstimator};
