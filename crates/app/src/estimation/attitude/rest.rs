//! Rest detection, which allows zero-velocity and zero-angular-rate updates.
//!
//! Rest is judged by windows. Within a window gyro and accelerometer must be quiet, and their means must match those at
//! the start of the rest. The magnetic field must match too: it shows a slow, even rotation, which the gyro alone cannot
//! tell from its own bias.

use crate::math::{Vector3, vector};

/// Greatest variance of the gyro within a window, (1 °/s)².
const MAX_GYRO_VARIANCE: f32 = 1.0_f32.to_radians() * 1.0_f32.to_radians();
/// Greatest variance of the accelerometer within a window, (0.35 m/s²)².
const MAX_ACCEL_VARIANCE: f32 = 0.35 * 0.35;
/// Greatest change of the mean rate since the first window of the rest.
const MAX_GYRO_CHANGE_RPS: f32 = 0.5_f32.to_radians();
/// Greatest change of the mean specific force since then.
const MAX_ACCEL_CHANGE_MPS2: f32 = 0.3;
/// Greatest change of the mean field since then. 0.5 °/s rotates a horizontal field of 20 µT this far in 3 s. The noise of
/// the means is 0.1 µT.
const MAX_FIELD_CHANGE_UT: f32 = 0.5;
/// Windows of 0.2 s in a row that are a rest without a magnetometer.
const MIN_WINDOWS: u8 = 7;
/// The same with a magnetometer, which takes longer to show a rotation.
const MIN_WINDOWS_WITH_FIELD: u8 = 20;
/// After this many windows an even rotation of 0.5 °/s would have shown in a horizontal field of 12 µT, so the rate is all
/// bias.
const CONFIRMING_WINDOWS: u8 = 35;
/// Windows in the mean of the initial field, and time constant of the current one.
const FIELD_WINDOWS: u8 = 6;

/// Detects rest, window by window.
#[derive(Clone, Debug, Default)]
pub(super) struct RestDetector {
    sums: Sums,
    /// Means of the first window of the rest.
    start: Option<Means>,
    windows: u8,
    initial_field_ut: Vector3,
    current_field_ut: Vector3,
}

/// A window at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rest {
    /// Mean rate: all of it gyro bias, unless the robot rotates slowly and evenly.
    pub rate_rps: Vector3,
    /// The field was steady for so long that the robot does not rotate.
    pub confirmed: bool,
}

/// Sums over one window.
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
    /// Forgets the current window and rest.
    #[inline(never)]
    pub fn reset(&mut self) {
        *self = Self::default();
    }

    /// Adds a sample, in body axes.
    pub fn feed(&mut self, gyro_rps: Vector3, accel_mps2: Vector3) {
        let sums = &mut self.sums;
        sums.gyro = vector::add(sums.gyro, gyro_rps);
        sums.gyro_squares += vector::dot(gyro_rps, gyro_rps);
        sums.accel = vector::add(sums.accel, accel_mps2);
        sums.accel_squares += vector::dot(accel_mps2, accel_mps2);
        sums.count = sums.count.saturating_add(1);
    }

    /// Ends a window. `field_ut` is the mean of the magnetometer in body axes.
    pub fn close_window(&mut self, field_ut: Option<Vector3>) -> Option<Rest> {
        let sums = core::mem::take(&mut self.sums);
        let Some(means) = sums.quiet_means() else {
            self.reset();
            return None;
        };
        if !self
            .start
            .as_ref()
            .is_some_and(|start| means.matches(start))
        {
            self.reset();
            self.start = Some(means);
        }
        self.windows = self.windows.saturating_add(1);
        if !self.field_is_steady(field_ut) {
            self.reset();
        }
        let needed = match field_ut {
            Some(_) => MIN_WINDOWS_WITH_FIELD,
            None => MIN_WINDOWS,
        };
        (self.windows >= needed).then_some(Rest {
            rate_rps: means.gyro_rps,
            confirmed: field_ut.is_some() && self.windows >= CONFIRMING_WINDOWS,
        })
    }

    /// Matching quiet windows in a row so far.
    pub const fn quiet_windows(&self) -> u8 {
        self.windows
    }

    fn field_is_steady(&mut self, field_ut: Option<Vector3>) -> bool {
        let Some(field_ut) = field_ut else {
            return true;
        };
        if self.windows <= FIELD_WINDOWS {
            let share = 1.0 / f32::from(self.windows);
            low_pass(&mut self.initial_field_ut, field_ut, share);
            self.current_field_ut = self.initial_field_ut;
            return true;
        }
        low_pass(
            &mut self.current_field_ut,
            field_ut,
            1.0 / f32::from(FIELD_WINDOWS),
        );
        is_near(
            self.current_field_ut,
            self.initial_field_ut,
            MAX_FIELD_CHANGE_UT,
        )
    }
}

impl Sums {
    /// The means, or `None` if the window was not quiet.
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
    fn matches(&self, other: &Self) -> bool {
        is_near(self.gyro_rps, other.gyro_rps, MAX_GYRO_CHANGE_RPS)
            && is_near(self.accel_mps2, other.accel_mps2, MAX_ACCEL_CHANGE_MPS2)
    }
}

fn low_pass(mean: &mut Vector3, value: Vector3, share: f32) {
    let step = vector::scale(vector::sub(value, *mean), share);
    *mean = vector::add(*mean, step);
}

fn is_near(a: Vector3, b: Vector3, limit: f32) -> bool {
    let difference = vector::sub(a, b);
    vector::dot(difference, difference) < limit * limit
}

#[cfg(test)]
mod tests;
