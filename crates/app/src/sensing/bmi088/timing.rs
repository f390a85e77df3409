//! Which instant a sample speaks of.

/// Delay of the gyro's low-pass with 47 Hz bandwidth. The datasheet gives no delay: a Butterworth filter of second order
/// has √2 / (2π · 47 Hz), a moving average of that bandwidth 4.71 ms.
const GYRO_FILTER_US: u64 = 4_790;
/// The registers are renewed at 400 Hz, at an instant that the reader does not know: half of 2.5 ms in the mean.
const GYRO_AGE_US: u64 = 1_250;
/// From the middle of the interval that a sample stands for, 5 ms, to its end.
const HALF_INTERVAL_US: u64 = 2_500;

/// End of the interval whose mean rate a sample read at `read_us` shows. The accelerometer's filter (75 Hz, 400 Hz) is
/// 1.8 ms quicker, which counts as the same.
pub(in crate::sensing) const fn measured_until_us(read_us: u64) -> u64 {
    read_us.saturating_sub(GYRO_FILTER_US + GYRO_AGE_US - HALF_INTERVAL_US)
}
