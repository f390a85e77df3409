//! Default settings of the wheels: those of `robots/fivebar.toml`.

use super::{WheelControllerConfig, WheelOdomConfig, robots};

impl Default for WheelOdomConfig {
    fn default() -> Self {
        robots::FIVEBAR.wheel_odom
    }
}

impl Default for WheelControllerConfig {
    fn default() -> Self {
        Self {
            max_vx_mps: 1.5,
            max_wz_rps: 4.0,
            kp_ma_per_mps: 60_000.0,
            current_limit_ma: robots::FIVEBAR.wheel_current_ma,
            open_loop_ma_per_mps: 1_000.0,
            feedback_timeout_us: 50_000,
        }
    }
}
