//! Plausibility of IMU samples: saturation is accepted for a while, impossible jumps are not.
//!
//! An impact can turn the robot faster than ±2000 °/s or accelerate it beyond ±12 g for a moment. Such a sample is used
//! and marked. A sensor may not jump further than its low-pass allows, stay saturated, or be saturated in its first
//! sample. A single outlier among the gyro's frames is replaced. After a time without a good sample the sensor is on
//! probation: only after some quiet samples in a row is it used again.

use super::{
    bmi088::{AccelRaw, GyroRaw},
    gyro_series::{self, GyroReading, SeriesEnd},
    imu_sample_error::ImuSampleError,
};
use crate::domain::age_us;

/// Samples further apart than this have frames missing in between.
const MAX_SERIES_GAP_US: u32 = 7_500;
/// Samples further apart than this are not compared.
const MAX_GAP_US: u32 = 20_000;
/// Most saturated samples in a row, 200 ms: longer than an impact or a spin takes.
const MAX_SATURATED: u8 = 40;
/// Plausible, unsaturated samples in a row that end the probation.
const PROBATION: u8 = 4;

/// A sample that has passed the checks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PlausibleSample {
    pub gyro: GyroReading,
    /// An axis of accelerometer or gyro is at the end of its range.
    pub saturated: bool,
}

#[derive(Clone, Copy, Debug)]
struct GyroSample {
    counts: [i16; 3],
    ts_us: u64,
}

/// The last sample that passed.
#[derive(Clone, Copy, Debug)]
struct AcceptedSample {
    end: SeriesEnd,
    sample: GyroSample,
}

/// The checks, with what they remember. To be called with every sample.
#[derive(Clone, Debug, Default)]
pub(super) struct Plausibility {
    last: Option<GyroSample>,
    last_good: Option<AcceptedSample>,
    saturated_in_row: u8,
    probation_left: u8,
}

impl Plausibility {
    /// Checks a sample that was read at `ts_us`.
    pub fn check(
        &mut self,
        accel: &AccelRaw,
        gyro: &GyroRaw,
        ts_us: u64,
    ) -> Result<PlausibleSample, ImuSampleError> {
        let sample = GyroSample {
            counts: gyro.counts,
            ts_us,
        };
        let before = self.last.replace(sample);
        let reading = self.read_gyro(gyro, ts_us);
        let saturated = reading.is_some_and(|reading| reading.clipped_ms != [0; 3])
            || accel.counts.into_iter().any(gyro_series::is_at_end);
        self.saturated_in_row = if saturated {
            self.saturated_in_row.saturating_add(1)
        } else {
            0
        };
        let Some(reading) = reading.filter(|_| self.is_plausible(&sample, before)) else {
            self.probation_left = PROBATION;
            return Err(ImuSampleError::Implausible);
        };
        if self.saturated_in_row > MAX_SATURATED {
            self.probation_left = PROBATION;
            return Err(ImuSampleError::Saturated);
        }
        if self.probation_left > 0 {
            self.probation_left = if saturated {
                PROBATION
            } else {
                self.probation_left.saturating_sub(1)
            };
            return Err(ImuSampleError::Implausible);
        }
        self.last_good = Some(AcceptedSample {
            end: reading.end,
            sample,
        });
        Ok(PlausibleSample {
            gyro: reading,
            saturated,
        })
    }

    /// `None` if the frames are not plausible.
    fn read_gyro(&self, gyro: &GyroRaw, ts_us: u64) -> Option<GyroReading> {
        let end = self
            .last_good
            .filter(|good| age_us(good.sample.ts_us, ts_us) <= MAX_SERIES_GAP_US)
            .map(|good| good.end);
        GyroReading::from_frames(gyro.frames(), end)
    }

    fn is_plausible(&mut self, sample: &GyroSample, before: Option<GyroSample>) -> bool {
        let near = |other: &GyroSample| age_us(other.ts_us, sample.ts_us);
        if let Some(good) = self
            .last_good
            .filter(|good| near(&good.sample) <= MAX_GAP_US)
        {
            // Within a series of frames each step has been checked already.
            let plausible = near(&good.sample) <= MAX_SERIES_GAP_US
                || gyro_series::is_possible_step(sample.counts, good.sample.counts);
            if plausible {
                self.probation_left = 0;
            }
            return plausible;
        }
        match before.filter(|before| near(before) <= MAX_GAP_US) {
            Some(before) => gyro_series::is_possible_step(sample.counts, before.counts),
            None => !sample.counts.into_iter().any(gyro_series::is_at_end),
        }
    }
}

#[cfg(test)]
mod tests;
