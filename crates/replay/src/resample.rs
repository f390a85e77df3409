//! Turns a recording of any rate into samples as the firmware's sensors deliver them.

use std::ops::Range;

use robot_plant::{
    recording::{self, Row},
    time::{MS, Ps, US},
};

/// The BMI088 is read at 200 Hz.
const IMU_PERIOD: Ps = 5 * MS;
/// The IST8310 is read at 50 Hz.
const IMU_SAMPLES_A_FIELD_SAMPLE: Ps = 4;
/// The age of the field at the end of the 5 ms that it is a mean over: it belongs to their middle.
pub const FIELD_AGE_US: u64 = IMU_PERIOD / US / 2;

/// The ranges that the firmware configures in the BMI088 (datasheet, registers 0x41 and 0x0F): ±12 g, ±2000 °/s.
const ACCEL_RANGE_MPS2: f64 = 12.0 * 9.806_65;
const GYRO_RANGE_RPS: f64 = 2_000.0 * std::f64::consts::PI / 180.0;

/// What the sensors measured in the 5 ms that end at `end_us`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Time in the recording.
    pub end_us: u64,
    /// `None` where the recording has no number. The firmware gets no sample then.
    pub motion: Option<Motion>,
    /// The field in the body frame. Only every fourth sample has one; it is `None` where the recording has no number.
    pub field_ut: Option<[f32; 3]>,
}

/// Means over the 5 ms in the body frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    pub gyro_rps: [f32; 3],
    /// Specific force, which is 9.8 m/s² upwards at rest.
    pub accel_mps2: [f32; 3],
    /// True if an axis was at the end of the BMI088's range at some time in the 5 ms. It is clipped there.
    pub saturated: bool,
    /// How long each axis of the gyro was clipped, in ms.
    pub gyro_clipped_ms: [u8; 3],
}

/// Returns a sample for every whole 5 ms of the recording. A row counts as constant over its interval, so the rows of a
/// recording at 200 Hz do not change.
pub fn samples(recording: &recording::Trial) -> Vec<Sample> {
    let period = recording.row_period();
    let rows = Rows {
        rows: recording.rows(),
        period,
    };
    // Row 0 ends at time 0. Windows that begin before row 0 are left out.
    let first = IMU_PERIOD.saturating_sub(period).div_ceil(IMU_PERIOD);
    let last = rows.rows.len().saturating_sub(1) as Ps * period / IMU_PERIOD;
    (first..=last)
        .map(|index| {
            rows.sample(
                index,
                (index - first).is_multiple_of(IMU_SAMPLES_A_FIELD_SAMPLE),
            )
        })
        .collect()
}

struct Rows<'a> {
    rows: &'a [Row],
    period: Ps,
}

impl Rows<'_> {
    fn sample(&self, index: Ps, with_field: bool) -> Sample {
        let end = index * IMU_PERIOD;
        // Counted from the start of row 0.
        let window = end + self.period - IMU_PERIOD..end + self.period;
        let gyro = self.mean(&window, |row| cut_off(row.gyro_rps, GYRO_RANGE_RPS));
        let accel = self.mean(&window, |row| cut_off(row.accel_mps2, ACCEL_RANGE_MPS2));
        let field = with_field.then(|| self.mean(&window, |row| row.field_ut));
        Sample {
            end_us: end / US,
            motion: gyro.zip(accel).map(|(gyro_rps, accel_mps2)| Motion {
                gyro_rps,
                accel_mps2,
                saturated: self.covered(&window).any(is_saturated),
                gyro_clipped_ms: self.clipped_ms(&window),
            }),
            field_ut: field.flatten(),
        }
    }

    /// Returns how long each axis of the gyro was clipped. The time is rounded up, so that any clipping shows.
    fn clipped_ms(&self, window: &Range<Ps>) -> [u8; 3] {
        let at_end = |row: &Row| {
            row.gyro_rps
                .map(|rate| f64::from(u8::from(rate.abs() >= GYRO_RANGE_RPS)))
        };
        let share = self.mean(window, at_end).unwrap_or_default();
        let ms = IMU_PERIOD as f64 / MS as f64;
        share.map(|share| (f64::from(share) * ms).ceil() as u8)
    }

    fn covered(&self, window: &Range<Ps>) -> impl Iterator<Item = &Row> {
        let last = (window.end - 1) / self.period;
        let indices = window.start / self.period..=last;
        indices.filter_map(|index| self.rows.get(usize::try_from(index).ok()?))
    }

    /// Returns `None` if a row in the window has no number.
    fn mean(&self, window: &Range<Ps>, value: impl Fn(&Row) -> [f64; 3]) -> Option<[f32; 3]> {
        let first = window.start / self.period;
        let mut sum = [0.0; 3];
        for (index, row) in (first..).zip(self.covered(window)) {
            let start = index * self.period;
            let covered = window.end.min(start + self.period) - window.start.max(start);
            let share = covered as f64 / (window.end - window.start) as f64;
            for (sum, axis) in sum.iter_mut().zip(value(row)) {
                *sum += share * axis;
            }
        }
        let mean = sum.map(|axis| axis as f32);
        mean.iter().all(|axis| axis.is_finite()).then_some(mean)
    }
}

/// Clips the value to the range. A value that is not finite stays as it is.
fn cut_off(value: [f64; 3], range: f64) -> [f64; 3] {
    value.map(|axis| match axis.is_finite() {
        true => axis.clamp(-range, range),
        false => axis,
    })
}

fn is_saturated(row: &Row) -> bool {
    let at_end = |value: [f64; 3], range: f64| value.iter().any(|axis| axis.abs() >= range);
    at_end(row.gyro_rps, GYRO_RANGE_RPS) || at_end(row.accel_mps2, ACCEL_RANGE_MPS2)
}
