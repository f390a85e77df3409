//! Tells a sensor at its limits from one that talks nonsense.
//!
//! A robot can be hit so that it turns beyond ±2000 °/s or is pushed beyond ±12 g for a moment: such a sample is used and
//! marked. It cannot jump as no low-pass lets it, nor stay beyond the range, nor wake up there. Single wrong frames of the
//! gyro among good ones are left out; when there has been no good sample for a while, nothing counts until a few quiet
//! ones in a row.

use super::{
    bmi088::{AccelRaw, GyroRaw},
    gyro_series::{self, GyroReading, SeriesEnd},
    imu_sample_error::ImuSampleError,
};
use crate::domain::age_us;

/// Samples further apart than this have frames missing between them.
const MAX_SERIES_GAP_US: u32 = 7_500;
/// Samples further apart than this are not compared.
const MAX_GAP_US: u32 = 20_000;
/// Samples in a row at the end of the range, 200 ms: more than a blow or a spin may take.
const MAX_SATURATED: u8 = 40;
/// Plausible samples inside the range before a sensor that talked nonsense counts again.
const PROBATION: u8 = 4;

/// What may be used of a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PlausibleSample {
    pub gyro: GyroReading,
    /// An axis of either die is at the end of its range.
    pub saturated: bool,
}

#[derive(Clone, Copy, Debug)]
struct GyroSample {
    counts: [i16; 3],
    ts_us: u64,
}

/// The last sample that counted.
#[derive(Clone, Copy, Debug)]
struct AcceptedSample {
    end: SeriesEnd,
    sample: GyroSample,
}

/// Call [`judge`](Self::judge) with every sample that was read.
#[derive(Clone, Debug, Default)]
pub(super) struct Plausibility {
    last: Option<GyroSample>,
    last_good: Option<AcceptedSample>,
    saturated_in_row: u8,
    probation_left: u8,
}

impl Plausibility {
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
        let Some(reading) = reading.filter(|_| self.is_sane(&sample, before)) else {
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

    /// None if no gyro turns like that.
    fn read_gyro(&self, gyro: &GyroRaw, ts_us: u64) -> Option<GyroReading> {
        let end = self
            .last_good
            .filter(|good| age_us(good.sample.ts_us, ts_us) <= MAX_SERIES_GAP_US)
            .map(|good| good.end);
        GyroReading::from_frames(gyro.frames(), end)
    }

    fn is_sane(&mut self, sample: &GyroSample, before: Option<GyroSample>) -> bool {
        let near = |other: &GyroSample| age_us(other.ts_us, sample.ts_us);
        if let Some(good) = self
            .last_good
            .filter(|good| near(&good.sample) <= MAX_GAP_US)
        {
            // Within a series each step has been judged already.
            let sane = near(&good.sample) <= MAX_SERIES_GAP_US
                || gyro_series::is_possible_step(sample.counts, good.sample.counts);
            if sane {
                self.probation_left = 0;
            }
            return sane;
        }
        match before.filter(|before| near(before) <= MAX_GAP_US) {
            Some(before) => gyro_series::is_possible_step(sample.counts, before.counts),
            None => !sample.counts.into_iter().any(gyro_series::is_at_end),
        }
    }
}

#[cfg(test)]
mod tests;
