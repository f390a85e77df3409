//! Thresholds of `SafetyPolicy` and `Arming`. Their ranges do not allow disabling a rule, except for the battery
//! limits.

use super::joints::{MAX_NM as MAX_JOINT_NM, MAX_RPS as MAX_JOINT_RPS};
use crate::{
    domain::MotorCurrent,
    tuning::parameter::{Parameter, ParameterKind, float, integer},
};

#[rustfmt::skip] // One line a setting.
pub static SAFETY: [Parameter; 20] = [
    integer!(0, "remote-timeout-us", "us", 30_000.0, 500_000.0, safety.remote_timeout_us),
    float!(1, "min-remote-quality", "", 0.1, 1.0, safety.min_remote_quality),
    integer!(2, "imu-timeout-us", "us", 10_000.0, 100_000.0, safety.imu_timeout_us),
    integer!(3, "command-timeout-us", "us", 15_000.0, 200_000.0, safety.command_timeout_us),
    integer!(4, "max-sensor-errors", "", 1.0, 1_000.0, safety.max_sensor_errors),
    integer!(5, "max-tx-failures", "", 1.0, 1_000.0, safety.max_tx_failures),
    float!(6, "stick-centre", "", 0.01, 0.3, safety.stick_centre),
    integer!(7, "arm-request-us", "us", 100_000.0, 10_000_000.0, safety.arm_request_us),
    integer!(8, "joint-timeout-us", "us", 5_000.0, 200_000.0, safety.joint_timeout_us),
    float!(9, "max-tilt-rad", "rad", 0.1, 1.57, safety.max_tilt_rad),
    float!(10, "max-wheel-c", "degC", 30.0, 120.0, safety.max_wheel_c),
    float!(11, "max-joint-c", "degC", 30.0, 120.0, safety.max_joint_c),
    float!(12, "battery-low-v", "V", 0.0, 60.0, safety.battery_low_v),
    float!(13, "battery-empty-v", "V", 0.0, 60.0, safety.battery_empty_v),
    integer!(14, "clear-hold-us", "us", 200_000.0, 10_000_000.0, safety.clear_hold_us),
    integer!(15, "resume-centred", "", 0.0, 1.0, safety.resume_centred),
    integer!(16, "pc-timeout-us", "us", 20_000.0, 500_000.0, safety.pc_timeout_us),
    integer!(17, "pc-frozen-us", "us", 0.0, 16_000_000.0, safety.pc_frozen_us),
    float!(18, "max-balance-tilt-rad", "rad", 0.1, 1.57, safety.max_balance_tilt_rad),
    integer!(19, "balance-tilt-us", "us", 0.0, 200_000.0, safety.balance_tilt_us),
];

#[rustfmt::skip] // One line a setting.
pub static STAND_UP: [Parameter; 4] = [
    integer!(0, "time-us", "us", 500_000.0, 10_000_000.0, stand_up.time_us),
    float!(1, "max-joint-nm", "N*m", 0.0, MAX_JOINT_NM, stand_up.max_joint_nm),
    float!(2, "max-joint-rps", "rad/s", 0.0, MAX_JOINT_RPS, stand_up.max_joint_rps),
    float!(3, "max-wheel-ma", "mA", 0.0, MotorCurrent::FULL_SCALE_MA, stand_up.max_wheel_ma),
];
