//! Which instant a sample speaks of.
//!
//! The datasheet gives no delay of the low-passes, only their bandwidth f. A Butterworth filter of second order has
//! √2 / 2πf; a moving average of the same bandwidth comes within 2 % of that.

/// Low-pass with 116 Hz.
const GYRO_FILTER_US: u64 = 1_940;
/// The gyro measures at 1000 Hz, at instants that the reader does not know: the newest frame is half of 1 ms old in the
/// mean.
const GYRO_AGE_US: u64 = 500;
/// A sample is the mean over 5 ms.
const INTERVAL_US: u64 = 5_000;
/// Low-pass with 80 Hz.
const ACCEL_FILTER_US: u64 = 2_810;
/// Half of 1/800 s.
const ACCEL_AGE_US: u64 = 625;

/// From the middle of what the gyro shows to the reading of it.
const GYRO_MIDDLE_US: u64 = GYRO_FILTER_US + GYRO_AGE_US + INTERVAL_US / 2;

/// Of the accelerometer's last sample in a mean that is as late as the gyro's.
pub(in crate::sensing) const PREVIOUS_ACCEL_WEIGHT: f32 =
    (GYRO_MIDDLE_US - ACCEL_FILTER_US - ACCEL_AGE_US) as f32 / INTERVAL_US as f32;

/// End of the interval whose mean rate a sample read at `read_us` shows.
pub(in crate::sensing) const fn interval_end_us(read_us: u64) -> u64 {
    read_us.saturating_sub(GYRO_FILTER_US + GYRO_AGE_US)
}
