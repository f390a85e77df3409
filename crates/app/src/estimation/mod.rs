//! Where is up, where is north, how fast: IMU, magnetometer and wheels → `StateEstimate`.

mod ins_estimator;

pub use ins_estimator::InsEstimator;
