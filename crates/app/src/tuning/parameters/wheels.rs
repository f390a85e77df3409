//! Wheel geometry and the wheel speed controller.

use crate::{
    domain::MotorCurrent,
    tuning::parameter::{Parameter, ParameterKind, float, integer, sign},
};

#[rustfmt::skip] // One line a setting.
pub static GEOMETRY: [Parameter; 5] = [
    float!(0, "radius-m", "m", 0.01, 0.5, wheel_odom.wheel_radius_m),
    float!(1, "track-m", "m", 0.05, 2.0, wheel_odom.wheel_track_m),
    float!(2, "gear-ratio", "", 1.0, 200.0, wheel_odom.gear_ratio),
    sign!(3, "sign-left", wheel_odom.rpm_sign_left),
    sign!(4, "sign-right", wheel_odom.rpm_sign_right),
];

#[rustfmt::skip] // One line a setting.
pub static CONTROLLER: [Parameter; 6] = [
    float!(0, "max-vx-mps", "m/s", 0.0, 10.0, wheel_ctrl.max_vx_mps),
    float!(1, "max-wz-rps", "rad/s", 0.0, 30.0, wheel_ctrl.max_wz_rps),
    float!(2, "kp-ma-per-mps", "mA/(m/s)", 0.0, 200_000.0, wheel_ctrl.kp_ma_per_mps),
    float!(3, "current-limit-ma", "mA", 0.0, MotorCurrent::FULL_SCALE_MA, wheel_ctrl.current_limit_ma),
    float!(4, "open-loop-ma-per-mps", "mA/(m/s)", 0.0, 20_000.0, wheel_ctrl.open_loop_ma_per_mps),
    integer!(5, "feedback-timeout-us", "us", 2_000.0, 200_000.0, wheel_ctrl.feedback_timeout_us),
];
