//! The estimator of the main chain (seed section 0.4).

use crate::domain::{ImuState, MagState, MotorFeedback, StateEstimate, WheelOdomConfig};

/// Called at 1 kHz with the latest samples.
#[derive(Clone, Debug)]
pub struct InsEstimator {
    odometry: WheelOdomConfig,
    estimate: StateEstimate,
}

impl InsEstimator {
    pub fn new(odometry: WheelOdomConfig) -> Self {
        Self {
            odometry,
            estimate: StateEstimate::default(),
        }
    }

    pub fn step(
        &mut self,
        _imu: &ImuState,
        _mag: &MagState,
        _motor: &MotorFeedback,
        now_us: u64,
    ) -> &StateEstimate {
        self.estimate.ts_us = now_us;
        &self.estimate
    }
}
