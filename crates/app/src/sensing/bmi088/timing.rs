//! Which instant a sample speaks of.

/// Delay of the gyro's low-pass with 116 Hz bandwidth. The datasheet gives no delay: a Butterworth filter of second order
/// has √2 / (2π · 116 Hz), a moving average of that bandwidth 1.91 ms.
const GYRO_FILTER_US: u64 = 1_940;
/// The gyro measures at 1000 Hz, at instants that the reader does not know: the newest frame is half of 1 ms old in the
/// mean.
const GYRO_AGE_US: u64 = 500;

/// End of the interval whose mean rate a sample read at `read_us` shows. The accelerometer's values are those of 1.8 ms
/// before it (75 Hz, 400 Hz: 3 ms of filter and 1.25 ms of age), the middle of the interval being 2.5 ms before it.
pub(in crate::sensing) const fn measured_until_us(read_us: u64) -> u64 {
    read_us.saturating_sub(GYRO_FILTER_US + GYRO_AGE_US)
}
