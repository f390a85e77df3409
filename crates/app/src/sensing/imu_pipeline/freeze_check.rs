//! Detection of a sensor that repeats old samples.

use crate::sensing::bmi088::{AccelRaw, GyroRaw};

/// Samples in a row that may have all six counts alike. At rest noise changes at least one of them nearly every time.
const MAX_REPEATS: u8 = 10;

#[derive(Clone, Copy, Debug)]
struct RawSample {
    accel_counts: [i16; 3],
    gyro_counts: [i16; 3],
    sensor_time: u32,
}

/// Compares each sample with the one before.
#[derive(Clone, Debug, Default)]
pub(super) struct FreezeCheck {
    last: Option<RawSample>,
    repeats: u8,
}

impl FreezeCheck {
    /// True if the sensor is frozen: its time stands still, the gyro has measured nothing new, or its counts repeat.
    pub fn is_frozen(&mut self, accel: &AccelRaw, gyro: &GyroRaw) -> bool {
        let sample = RawSample {
            accel_counts: accel.counts,
            gyro_counts: gyro.counts,
            sensor_time: accel.sensor_time,
        };
        let Some(last) = self.last.replace(sample) else {
            return !gyro.fresh;
        };
        let alike =
            last.accel_counts == sample.accel_counts && last.gyro_counts == sample.gyro_counts;
        self.repeats = if alike {
            self.repeats.saturating_add(1)
        } else {
            0
        };
        last.sensor_time == sample.sensor_time || !gyro.fresh || self.repeats > MAX_REPEATS
    }
}
