//! What the robot knows about its own motion.

/// Output of the estimator (seed section 3.2). World frame: ENU (x east, y north, z up).
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct StateEstimate {
    /// Rotates body vectors (x forward, y left, z up) into the world frame; w first.
    pub q_wxyz: [f32; 4],
    /// Roll, pitch, yaw from `q_wxyz`, for display only: wraps at ±π.
    pub rpy_rad: [f32; 3],
    /// World frame.
    pub vel_mps: [f32; 3],
    /// World frame, from where the robot booted.
    pub pos_m: [f32; 3],
    /// Offset found beyond the one already taken out of the IMU samples.
    pub gyro_bias_rps: [f32; 3],
    pub accel_bias_mps2: [f32; 3],
    pub ts_us: u64,
    /// False while the IMU is silent, time jumped, or nothing was received yet.
    pub valid: bool,
}

impl Default for StateEstimate {
    fn default() -> Self {
        Self {
            q_wxyz: [1.0, 0.0, 0.0, 0.0],
            rpy_rad: [0.0; 3],
            vel_mps: [0.0; 3],
            pos_m: [0.0; 3],
            gyro_bias_rps: [0.0; 3],
            accel_bias_mps2: [0.0; 3],
            ts_us: 0,
            valid: false,
        }
    }
}
