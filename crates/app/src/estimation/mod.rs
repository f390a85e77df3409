//! Where is up, where is north, how fast: IMU, magnetometer and wheels → `StateEstimate`.
//!
//! The attitude filter follows VQF (D. Laidig, T. Seel, "VQF: Highly accurate IMU orientation estimation with bias
//! estimation and magnetic disturbance rejection", Information Fusion 91, 2023): gravity is low-passed in a frame that
//! turns with the gyro, heading is corrected by one angle about the vertical, the gyro offset by a small Kalman filter.

mod attitude;
mod field_monitor;
mod gyro_bias;
mod heading;
mod ins_estimator;
mod low_pass;
mod motion;
mod rest;

pub use ins_estimator::InsEstimator;

/// The IMU's sampling period, which all filter coefficients are made for.
const SAMPLE_S: f32 = 0.005;
