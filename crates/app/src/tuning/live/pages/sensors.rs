//! Pages of IMU, magnetometer and attitude.

use super::*;

/// Specific force.
pub const ACCEL: [LiveField; 3] = [
    measure!("x-mps2", "m/s2", 16, 200, |live, _| accel(live, 0)),
    measure!("y-mps2", "m/s2", 16, 200, |live, _| accel(live, 1)),
    measure!("z-mps2", "m/s2", 16, 200, |live, _| accel(live, 2)),
];

pub const GYRO: [LiveField; 3] = [
    measure!("x-dps", "deg/s", 16, 10, |live, _| gyro(live, 0)),
    measure!("y-dps", "deg/s", 16, 10, |live, _| gyro(live, 1)),
    measure!("z-dps", "deg/s", 16, 10, |live, _| gyro(live, 2)),
];

pub const MAG: [LiveField; 3] = [
    measure!("x-ut", "uT", 16, 10, |live, _| mag(live, 0)),
    measure!("y-ut", "uT", 16, 10, |live, _| mag(live, 1)),
    measure!("z-ut", "uT", 16, 10, |live, _| mag(live, 2)),
];

pub const ATTITUDE: [LiveField; 3] = [
    measure!("roll-deg", "deg", 16, 100, |live, _| angle_deg(live, 0)),
    measure!("pitch-deg", "deg", 16, 100, |live, _| angle_deg(live, 1)),
    measure!("yaw-deg", "deg", 16, 100, |live, _| angle_deg(live, 2)),
];

pub const IMU: [LiveField; 7] = [
    measure!("temperature-c", "degC", 16, 100, |live, _| {
        match live.diagnostics.imu_status.heater.temperature_c {
            0.0 => f32::NAN,
            measured => measured,
        }
    }),
    measure!("heater-percent", "%", 8, 1, |live, _| live
        .diagnostics
        .imu_status
        .heater
        .duty
        * 100.0),
    choice!(
        "heater",
        3,
        &["off", "heating", "holding", "cut-off"],
        |live, _| live.diagnostics.imu_status.heater.state as u32
    ),
    choice!(
        "calibration",
        3,
        &CALIBRATION,
        |live, _| live.diagnostics.imu_status.calibration.state as u32
    ),
    choice!(
        "warmth",
        3,
        &["unsettled", "at-target", "settled", "unknown"],
        |live, _| live.diagnostics.imu_status.calibration.warmth as u32
    ),
    measure!("progress-percent", "%", 8, 1, |live, _| live
        .diagnostics
        .imu_status
        .calibration
        .progress
        * 100.0),
    set!("marks", 3, |bit| named(&MARKS, bit), |live, _| {
        marks([
            live.diagnostics.imu_calibrated,
            live.diagnostics.estimate.valid,
            live.diagnostics.sensors.imu.saturated,
        ])
    }),
];

pub const HEALTH: [LiveField; 5] = [
    set!("ready", 2, |bit| named(&["imu", "mag"], bit), |live, _| {
        marks([
            live.diagnostics.imu_health.ready,
            live.diagnostics.mag_health.ready,
        ])
    }),
    count!("imu-errors", "", 12, |live, _| live
        .diagnostics
        .imu_health
        .errors),
    count!("mag-errors", "", 12, |live, _| live
        .diagnostics
        .mag_health
        .errors),
    count!("imu-restarts", "", 8, |live, _| live
        .diagnostics
        .imu_health
        .reinits),
    count!("mag-restarts", "", 8, |live, _| live
        .diagnostics
        .mag_health
        .reinits),
];

/// IMU samples that were rejected.
pub const REJECTS: [LiveField; 4] = [
    count!("absent", "", 12, |live, _| live
        .diagnostics
        .imu_status
        .rejects
        .absent),
    count!("frozen", "", 12, |live, _| live
        .diagnostics
        .imu_status
        .rejects
        .frozen),
    count!("implausible", "", 12, |live, _| live
        .diagnostics
        .imu_status
        .rejects
        .implausible),
    count!("saturated", "", 12, |live, _| live
        .diagnostics
        .imu_status
        .rejects
        .saturated),
];

/// Faults of the gyro's buffer.
pub const GYRO_BUFFER: [LiveField; 4] = [
    count!("spikes", "", 12, |live, _| live
        .diagnostics
        .imu_status
        .gyro_buffer
        .spikes),
    count!("differences", "", 12, |live, _| live
        .diagnostics
        .imu_status
        .gyro_buffer
        .differences),
    count!("resets", "", 12, |live, _| live
        .diagnostics
        .imu_status
        .gyro_buffer
        .resets),
    count!("overruns", "", 12, |live, _| live
        .diagnostics
        .imu_status
        .gyro_buffer
        .overruns),
];

/// The offset that is removed.
pub const GYRO_BIAS: [LiveField; 3] = [
    measure!("x-dps", "deg/s", 16, 1_000, |live, _| bias(live, 0)),
    measure!("y-dps", "deg/s", 16, 1_000, |live, _| bias(live, 1)),
    measure!("z-dps", "deg/s", 16, 1_000, |live, _| bias(live, 2)),
];

const CALIBRATION: [&str; 5] = [
    "waiting-for-temperature",
    "waiting-for-stillness",
    "measuring",
    "done",
    "offset-refused",
];
const MARKS: [&str; 3] = ["calibrated", "attitude-valid", "saturated"];

/// NaN before the first sample, at time 0.
fn axis(vector: [f32; 3], axis: usize, ts_us: u64) -> f32 {
    match vector.get(axis) {
        Some(value) if ts_us != 0 => *value,
        _ => f32::NAN,
    }
}

fn accel(live: &LiveSource<'_>, index: usize) -> f32 {
    let imu = &live.diagnostics.sensors.imu;
    axis(imu.accel_mps2, index, imu.ts_us)
}

fn gyro(live: &LiveSource<'_>, index: usize) -> f32 {
    let imu = &live.diagnostics.sensors.imu;
    axis(imu.gyro_dps, index, imu.ts_us)
}

fn bias(live: &LiveSource<'_>, index: usize) -> f32 {
    let imu = &live.diagnostics.sensors.imu;
    axis(imu.gyro_bias_dps, index, imu.ts_us)
}

fn mag(live: &LiveSource<'_>, index: usize) -> f32 {
    let mag = &live.diagnostics.sensors.mag;
    axis(mag.mag_ut, index, mag.ts_us)
}

fn angle_deg(live: &LiveSource<'_>, index: usize) -> f32 {
    let estimate = &live.diagnostics.estimate;
    axis(estimate.rpy_rad, index, estimate.ts_us).to_degrees()
}
