//! The instant that a sample stands for.
//!
//! The datasheet gives the bandwidth f of the low-passes but no delay. The delay of a second-order Butterworth filter,
//! √2 / 2πf, is taken. A moving average of the same bandwidth is within 2 % of it.

/// Delay of the gyro's low-pass of 116 Hz.
const GYRO_FILTER_US: u64 = 1_940;
/// Mean age of the newest frame: half of the gyro's period of 1 ms, as its sampling instants are not known.
const GYRO_AGE_US: u64 = 500;
/// Interval of which a gyro sample is the mean.
const INTERVAL_US: u64 = 5_000;
/// Delay of the accelerometer's low-pass of 80 Hz.
const ACCEL_FILTER_US: u64 = 2_810;
/// Mean age of the newest acceleration: half of 1/800 s.
const ACCEL_AGE_US: u64 = 625;

/// Time from the middle of the gyro's interval to its reading.
const GYRO_MIDDLE_US: u64 = GYRO_FILTER_US + GYRO_AGE_US + INTERVAL_US / 2;

/// Weight of the previous acceleration in a mean that is as late as the gyro's sample.
pub(in crate::sensing) const PREVIOUS_ACCEL_WEIGHT: f32 =
    (GYRO_MIDDLE_US - ACCEL_FILTER_US - ACCEL_AGE_US) as f32 / INTERVAL_US as f32;

/// End of the interval whose mean rate is read at `read_us`.
pub(in crate::sensing) const fn interval_end_us(read_us: u64) -> u64 {
    read_us.saturating_sub(GYRO_FILTER_US + GYRO_AGE_US)
}
