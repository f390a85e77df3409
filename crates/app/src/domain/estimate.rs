//! The estimate of the robot's motion.

/// Output of the estimator. The world frame is ENU (x east, y north, z up).
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct StateEstimate {
    /// Rotation from the body frame (x forward, y left, z up) to the world frame, w first.
    pub q_wxyz: [f32; 4],
    /// Roll, pitch, yaw from `q_wxyz`, for display only. They wrap at ±π.
    pub rpy_rad: [f32; 3],
    /// Velocity of the middle of the axle in the world frame. It comes from the accelerometer, corrected by the
    /// wheels that roll. When no wheel has reported for 2 s it fades to zero.
    pub vel_mps: [f32; 3],
    /// Position in the world frame from where the robot booted: the integral of `vel_mps`.
    pub pos_m: [f32; 3],
    /// Gyro offset found in addition to the one already removed from the IMU samples.
    pub gyro_bias_rps: [f32; 3],
    /// Accelerometer offset in the body frame, at most ±0.6: what it shows beyond gravity and motion. Part of it is
    /// an error of the horizon.
    pub accel_bias_mps2: [f32; 3],
    /// Time of the tick to which the attitude was extrapolated. 0 = none yet.
    pub ts_us: u64,
    /// Whether the attitude can be trusted. The last IMU sample is at most 25 ms old, and 100 consecutive samples
    /// (0.5 s) were used since the latest of these events:
    ///
    /// - boot, or a gap of more than 100 ms between samples;
    /// - a sample that no sensor can measure (NaN, infinite, out of range);
    /// - a tick whose time ran backwards, stood still or jumped by more than 20 ms;
    /// - a rest that showed the attitude to be wrong (offset by more than 1 °/s, up by more than 30°), after which it
    ///   jumps.
    ///
    /// It is also false after a rotation beyond the gyro's range, or such a gap, until 0.6 s of rest or some seconds
    /// of motion have shown the vertical again. While it is false, the other fields hold the last good values. It
    /// says nothing about heading (the magnetometer may be missing) or wheels.
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
