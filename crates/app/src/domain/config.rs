//! Values that fit this code to one robot.

/// Wheel geometry (seed section 5.1).
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct WheelOdomConfig {
    pub wheel_radius_m: f32,
    /// Distance of the two contact points.
    pub wheel_track_m: f32,
    /// Rotor turns a wheel turn.
    pub gear_ratio: f32,
    /// +1 or −1: rotor direction that drives the robot forward.
    pub rpm_sign_left: f32,
    pub rpm_sign_right: f32,
}

impl Default for WheelOdomConfig {
    fn default() -> Self {
        Self {
            wheel_radius_m: 0.06,
            wheel_track_m: 0.42,
            gear_ratio: 3591.0 / 187.0,
            rpm_sign_left: 1.0,
            rpm_sign_right: -1.0,
        }
    }
}

impl WheelOdomConfig {
    /// Sign of wheel 0 = left, 1 = right.
    pub const fn rpm_signs(&self) -> [f32; 2] {
        [self.rpm_sign_left, self.rpm_sign_right]
    }

    /// Ground speed in m/s of one rotor revolution a minute.
    pub fn mps_per_rpm(&self) -> f32 {
        self.wheel_radius_m * (core::f32::consts::TAU / 60.0) / self.gear_ratio
    }
}

/// Wheel speed controller (seed section 5.1).
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct WheelControllerConfig {
    /// Speed at full stick.
    pub max_vx_mps: f32,
    /// Turn rate at full stick.
    pub max_wz_rps: f32,
    /// Motor current for each m/s of wheel speed error.
    pub kp_ma_per_mps: f32,
    pub current_limit_ma: f32,
    /// Without wheel feedback: motor current for each m/s of wanted wheel speed.
    pub open_loop_ma_per_mps: f32,
    /// Feedback older than this counts as none.
    pub feedback_timeout_us: u32,
}

impl Default for WheelControllerConfig {
    fn default() -> Self {
        Self {
            max_vx_mps: 1.5,
            max_wz_rps: 4.0,
            kp_ma_per_mps: 60_000.0,
            current_limit_ma: 8_000.0,
            open_loop_ma_per_mps: 1_000.0,
            feedback_timeout_us: 50_000,
        }
    }
}

/// Limits of `SafetyPolicy` and `Arming`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct SafetyConfig {
    /// A remote frame older than this: remote lost.
    pub remote_timeout_us: u32,
    /// Good fraction of the last 64 remote frames below this: link too bad to drive.
    pub min_remote_quality: f32,
    pub imu_timeout_us: u32,
    /// A command on the logic bus older than this is zero.
    pub command_timeout_us: u32,
    /// Errors a sensor may add to its leaky account (one forgiven every 100 ms) before safe mode.
    pub max_sensor_errors: u32,
    /// Frames that may fail to leave in a row before a bus counts as congested.
    pub max_tx_failures: u32,
    /// How far a stick may be off centre while arming, 0 … 1.
    pub stick_centre: f32,
    /// How long a flip of the enable switch keeps asking; afterwards it must go off and on again.
    pub arm_request_us: u32,
}

impl Default for SafetyConfig {
    fn default() -> Self {
        Self {
            remote_timeout_us: 100_000,
            min_remote_quality: 0.5,
            imu_timeout_us: 25_000,
            command_timeout_us: 50_000,
            max_sensor_errors: 20,
            max_tx_failures: 20,
            stick_centre: 0.05,
            arm_request_us: 3_000_000,
        }
    }
}

/// Sensor axes = body axes (x forward, y left, z up): calibrated = (raw − bias) · scale.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct ImuCalibration {
    pub accel_bias_mps2: [f32; 3],
    pub accel_scale: [f32; 3],
    /// Stored offset; the start-up calibration replaces it.
    pub gyro_bias_dps: [f32; 3],
    pub gyro_scale: [f32; 3],
}

impl Default for ImuCalibration {
    fn default() -> Self {
        Self {
            accel_bias_mps2: [0.0; 3],
            accel_scale: [1.0; 3],
            gyro_bias_dps: [0.0; 3],
            gyro_scale: [1.0; 3],
        }
    }
}

/// Hard-iron offset and per-axis scale, applied in the body frame.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct MagCalibration {
    pub bias_ut: [f32; 3],
    pub scale: [f32; 3],
}

impl Default for MagCalibration {
    fn default() -> Self {
        Self {
            bias_ut: [0.0; 3],
            scale: [1.0; 3],
        }
    }
}
