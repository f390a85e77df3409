//! Does the robot stand still?
//!
//! Judged window by window: gyro, accelerometer and magnetometer must be quiet within it, and agree with when the rest
//! began. The field shows a slow, even turn that the gyro alone cannot tell from its own bias.

use crate::math::{Vector3, vector};

/// Mean square of the change within a window: (1 °/s)², (0.35 m/s²)².
const MAX_GYRO_VARIANCE: f32 = 1.0_f32.to_radians() * 1.0_f32.to_radians();
const MAX_ACCEL_VARIANCE: f32 = 0.35 * 0.35;
/// Against the first window of the rest.
const MAX_GYRO_CHANGE_RPS: f32 = 0.5_f32.to_radians();
const MAX_ACCEL_CHANGE_MPS2: f32 = 0.3;
/// 0.5 °/s turns a level field of 20 µT by this in 3 s. Noise of the means compared: 0.1 µT.
const MAX_FIELD_CHANGE_UT: f32 = 0.5;
/// Rest is believed after so many windows of 0.2 s in a row; where the field is watched it takes longer to see a turn.
const WINDOWS: u8 = 7;
const WINDOWS_WITH_FIELD: u8 = 20;
/// … and after so many an even turn of 0.5 °/s would have shown in a level field of 12 µT: then the rate is all offset.
const WINDOWS_OF_PROOF: u8 = 35;
/// The field when the rest began is the mean of so many windows; the field now as many, the older the less.
const FIELD_WINDOWS: u8 = 6;

#[derive(Clone, Debug, Default)]
pub(super) struct RestDetector {
    sums: Sums,
    start: Option<Means>,
    windows: u8,
    field_then_ut: Vector3,
    field_now_ut: Vector3,
}

/// A window of a rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rest {
    /// Mean rate, all of it the gyro's offset unless this is a slow even turn.
    pub rate_rps: Vector3,
    /// The field stood still for long enough: it is no turn.
    pub proven: bool,
}

/// Of one window.
#[derive(Clone, Debug, Default)]
struct Sums {
    gyro: Vector3,
    gyro_squares: f32,
    accel: Vector3,
    accel_squares: f32,
    count: u8,
}

#[derive(Clone, Copy, Debug)]
struct Means {
    gyro_rps: Vector3,
    accel_mps2: Vector3,
}

impl RestDetector {
    #[inline(never)]
    pub fn restart(&mut self) {
        *self = Self::default();
    }

    pub fn feed(&mut self, gyro_rps: Vector3, accel_mps2: Vector3) {
        let sums = &mut self.sums;
        sums.gyro = vector::add(sums.gyro, gyro_rps);
        sums.gyro_squares += vector::dot(gyro_rps, gyro_rps);
        sums.accel = vector::add(sums.accel, accel_mps2);
        sums.accel_squares += vector::dot(accel_mps2, accel_mps2);
        sums.count = sums.count.saturating_add(1);
    }

    /// Ends a window. `field_ut`: mean of the magnetometer in the body. If at rest, what that shows.
    pub fn close(&mut self, field_ut: Option<Vector3>) -> Option<Rest> {
        let sums = core::mem::take(&mut self.sums);
        let Some(means) = sums.quiet_means() else {
            self.restart();
            return None;
        };
        if !self
            .start
            .as_ref()
            .is_some_and(|start| means.resemble(start))
        {
            self.restart();
            self.start = Some(means);
        }
        self.windows = self.windows.saturating_add(1);
        if !self.field_stands(field_ut) {
            self.restart();
        }
        let needed = match field_ut {
            Some(_) => WINDOWS_WITH_FIELD,
            None => WINDOWS,
        };
        (self.windows >= needed).then_some(Rest {
            rate_rps: means.gyro_rps,
            proven: field_ut.is_some() && self.windows >= WINDOWS_OF_PROOF,
        })
    }

    /// Windows in a row so far that were quiet and alike.
    pub const fn quiet_windows(&self) -> u8 {
        self.windows
    }

    fn field_stands(&mut self, field_ut: Option<Vector3>) -> bool {
        let Some(field_ut) = field_ut else {
            return true;
        };
        if self.windows <= FIELD_WINDOWS {
            let share = 1.0 / f32::from(self.windows);
            approach(&mut self.field_then_ut, field_ut, share);
            self.field_now_ut = self.field_then_ut;
            return true;
        }
        approach(
            &mut self.field_now_ut,
            field_ut,
            1.0 / f32::from(FIELD_WINDOWS),
        );
        is_near(self.field_now_ut, self.field_then_ut, MAX_FIELD_CHANGE_UT)
    }
}

impl Sums {
    /// None if the window was not quiet.
    fn quiet_means(&self) -> Option<Means> {
        let share = 1.0 / f32::from(if self.count == 0 { 1 } else { self.count });
        let means = Means {
            gyro_rps: vector::scale(self.gyro, share),
            accel_mps2: vector::scale(self.accel, share),
        };
        let variance = |squares: f32, mean: Vector3| squares * share - vector::dot(mean, mean);
        let quiet = self.count > 0
            && variance(self.gyro_squares, means.gyro_rps) < MAX_GYRO_VARIANCE
            && variance(self.accel_squares, means.accel_mps2) < MAX_ACCEL_VARIANCE;
        quiet.then_some(means)
    }
}

impl Means {
    fn resemble(&self, other: &Self) -> bool {
        is_near(self.gyro_rps, other.gyro_rps, MAX_GYRO_CHANGE_RPS)
            && is_near(self.accel_mps2, other.accel_mps2, MAX_ACCEL_CHANGE_MPS2)
    }
}

fn approach(mean: &mut Vector3, value: Vector3, share: f32) {
    let step = vector::scale(vector::sub(value, *mean), share);
    *mean = vector::add(*mean, step);
}

fn is_near(a: Vector3, b: Vector3, limit: f32) -> bool {
    let difference = vector::sub(a, b);
    vector::dot(difference, difference) < limit * limit
}

#[cfg(test)]
mod tests;
