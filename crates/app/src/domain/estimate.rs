//! What the robot knows about its own motion.

/// Output of the estimator. World frame: ENU (x east, y north, z up).
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct StateEstimate {
    /// Rotates body vectors (x forward, y left, z up) into the world frame; w first.
    pub q_wxyz: [f32; 4],
    /// Roll, pitch, yaw from `q_wxyz`, for display only: wraps at ±π.
    pub rpy_rad: [f32; 3],
    /// World frame, of the middle of the axle: the accelerometer's, corrected by the wheels that roll. With no wheel
    /// heard for 2 s it fades to zero.
    pub vel_mps: [f32; 3],
    /// World frame, from where the robot booted: `vel_mps` added up.
    pub pos_m: [f32; 3],
    /// Offset found beyond the one already taken out of the IMU samples.
    pub gyro_bias_rps: [f32; 3],
    /// Body frame, ±0.6 at most: what the accelerometer shows beyond gravity and motion, part of it a horizon that is
    /// slightly off.
    pub accel_bias_mps2: [f32; 3],
    /// Tick it is for; attitude is carried on to this time. 0 = none yet.
    pub ts_us: u64,
    /// True if the attitude can be trusted: the last IMU sample is at most 25 ms old, and 100 samples in a row (0.5 s)
    /// were used since boot, since a gap of more than 100 ms between samples, since a sample that no sensor can measure
    /// (NaN, infinite, out of range), since the ticks' time last ran backwards, stood still or jumped by more than 20 ms,
    /// and since a rest showed the attitude to be wrong (offset by more than 1 °/s, up by more than 30°), upon which it
    /// jumps. False also from a turn beyond the gyro's range, or such a gap, until 0.6 s of rest or some seconds of
    /// motion have shown where up is. While false the other fields hold what is left of the last good ones. Says nothing
    /// about heading (the magnetometer may be missing) or wheels.
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
