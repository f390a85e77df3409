//! Sensor calibration and the IMU's heater.

use crate::tuning::parameter::{Parameter, ParameterKind, float};

/// BMI088 datasheet: zero-g offset 20 mg typical. Six times that means a broken sensor.
const ACCEL_BIAS_MPS2: f32 = 1.2;
/// BMI088 datasheet: zero-rate offset ±1 °/s typical.
const GYRO_BIAS_DPS: f32 = 10.0;
const MIN_SCALE: f32 = 0.8;
const MAX_SCALE: f32 = 1.2;
/// Hard iron of nearby motors. The IST8310 measures up to 1600 µT.
const MAG_BIAS_UT: f32 = 1_000.0;

#[rustfmt::skip] // One line a setting.
pub static IMU: [Parameter; 12] = [
    float!(0, "accel-bias-x-mps2", "m/s2", -ACCEL_BIAS_MPS2, ACCEL_BIAS_MPS2, imu.accel_bias_mps2[0]),
    float!(1, "accel-bias-y-mps2", "m/s2", -ACCEL_BIAS_MPS2, ACCEL_BIAS_MPS2, imu.accel_bias_mps2[1]),
    float!(2, "accel-bias-z-mps2", "m/s2", -ACCEL_BIAS_MPS2, ACCEL_BIAS_MPS2, imu.accel_bias_mps2[2]),
    float!(3, "accel-scale-x", "", MIN_SCALE, MAX_SCALE, imu.accel_scale[0]),
    float!(4, "accel-scale-y", "", MIN_SCALE, MAX_SCALE, imu.accel_scale[1]),
    float!(5, "accel-scale-z", "", MIN_SCALE, MAX_SCALE, imu.accel_scale[2]),
    float!(6, "gyro-bias-x-dps", "deg/s", -GYRO_BIAS_DPS, GYRO_BIAS_DPS, imu.gyro_bias_dps[0]),
    float!(7, "gyro-bias-y-dps", "deg/s", -GYRO_BIAS_DPS, GYRO_BIAS_DPS, imu.gyro_bias_dps[1]),
    float!(8, "gyro-bias-z-dps", "deg/s", -GYRO_BIAS_DPS, GYRO_BIAS_DPS, imu.gyro_bias_dps[2]),
    float!(9, "gyro-scale-x", "", MIN_SCALE, MAX_SCALE, imu.gyro_scale[0]),
    float!(10, "gyro-scale-y", "", MIN_SCALE, MAX_SCALE, imu.gyro_scale[1]),
    float!(11, "gyro-scale-z", "", MIN_SCALE, MAX_SCALE, imu.gyro_scale[2]),
];

/// Both sides of the symmetric matrix are one setting.
macro_rules! off_diagonal {
    ($index:literal, $name:literal, $row:literal, $column:literal) => {
        Parameter {
            set: |config, value| {
                config.mag.soft_iron[$row][$column] = value;
                config.mag.soft_iron[$column][$row] = value;
            },
            ..float!($index, $name, "", -1.0, 1.0, mag.soft_iron[$row][$column])
        }
    };
}

#[rustfmt::skip] // One line a setting.
pub static MAG: [Parameter; 9] = [
    float!(0, "bias-x-ut", "uT", -MAG_BIAS_UT, MAG_BIAS_UT, mag.bias_ut[0]),
    float!(1, "bias-y-ut", "uT", -MAG_BIAS_UT, MAG_BIAS_UT, mag.bias_ut[1]),
    float!(2, "bias-z-ut", "uT", -MAG_BIAS_UT, MAG_BIAS_UT, mag.bias_ut[2]),
    float!(3, "soft-iron-xx", "", 0.2, 5.0, mag.soft_iron[0][0]),
    float!(4, "soft-iron-yy", "", 0.2, 5.0, mag.soft_iron[1][1]),
    float!(5, "soft-iron-zz", "", 0.2, 5.0, mag.soft_iron[2][2]),
    off_diagonal!(6, "soft-iron-xy", 0, 1),
    off_diagonal!(7, "soft-iron-xz", 0, 2),
    off_diagonal!(8, "soft-iron-yz", 1, 2),
];

#[rustfmt::skip] // One line a setting.
pub static HEATER: [Parameter; 4] = [
    // The sensor is specified up to 85 °C, and other parts of the board are nearby.
    float!(0, "target-c", "degC", 0.0, 55.0, heater.target_c),
    float!(1, "kp", "1/K", 0.0, 10.0, heater.kp),
    float!(2, "ki", "1/(K*s)", 0.0, 10.0, heater.ki),
    float!(3, "max-duty", "", 0.0, 1.0, heater.max_duty),
];
