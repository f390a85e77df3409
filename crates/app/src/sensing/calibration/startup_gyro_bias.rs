//! The gyro bias as the mean over the first second in which the robot stands still.

use crate::{
    domain::age_us,
    math::{Vector3, vector},
};

const MIN_SAMPLES: u16 = 200;
/// A robot that rocks in so many first samples is not still, and its second begins again at once.
const CHECKED_SAMPLES: u16 = 50;
/// Matching samples after which the robot counts as still, 50 ms.
const SETTLING_SAMPLES: u16 = 10;
const MIN_SPAN_US: u32 = 1_000_000;
/// A longer pause in the samples starts the second again.
const MAX_PAUSE_US: u32 = 50_000;
/// Largest standard deviation of a still robot. The noise of the BMI088, 0.014 °/s/√Hz, is 0.14 °/s RMS in means over 5
/// ms.
const MAX_GYRO_STD_DPS: f32 = 0.4;
const MAX_GYRO_EXCURSION_DPS: f32 = 3.0;
/// Largest difference from the stored bias (datasheet: ±1 °/s typical). A larger one is more likely a slow, even
/// rotation.
const MAX_OFFSET_DPS: f32 = 2.0;
const GRAVITY_MPS2: f32 = 9.806_65;
const MAX_GRAVITY_ERROR_MPS2: f32 = 1.0;
const MAX_ACCEL_EXCURSION_MPS2: f32 = 0.7;

/// Measures the bias. It is fed with every sample until the first still second with a plausible bias.
#[derive(Clone, Debug, Default)]
pub struct StartupGyroBias {
    window: Option<Window>,
    bias_dps: Option<Vector3>,
    refused: bool,
}

/// Sums over the still second, relative to its first sample so that single precision is enough.
#[derive(Clone, Debug)]
struct Window {
    start_us: u64,
    last_us: u64,
    samples: u16,
    first_gyro_dps: Vector3,
    first_accel_mps2: Vector3,
    sum_dps: Vector3,
    sum_squares: Vector3,
}

impl StartupGyroBias {
    /// Starts the second again, unless the bias is known.
    pub fn restart(&mut self) {
        self.window = None;
        self.refused = false;
    }

    /// True if the last still second showed a rate too large for a bias and the robot has stood still since.
    pub const fn refused(&self) -> bool {
        self.refused
    }

    /// True once the robot has stood still for 50 ms.
    pub fn is_measuring(&self) -> bool {
        self.samples() > SETTLING_SAMPLES
    }

    /// Elapsed part of the still second, 0 … 1.
    pub fn progress(&self) -> f32 {
        if self.bias_dps.is_some() {
            1.0
        } else {
            f32::from(self.samples().min(MIN_SAMPLES)) / f32::from(MIN_SAMPLES)
        }
    }

    fn samples(&self) -> u16 {
        self.window.as_ref().map_or(0, |window| window.samples)
    }

    /// The bias in °/s, once known.
    pub const fn bias_dps(&self) -> Option<Vector3> {
        self.bias_dps
    }

    /// Takes a sample. `gyro_dps` still has its bias.
    pub fn feed(
        &mut self,
        gyro_dps: Vector3,
        accel_mps2: Vector3,
        stored_offset_dps: Vector3,
        ts_us: u64,
    ) {
        if self.bias_dps.is_some() {
            return;
        }
        let window = match self.window.take() {
            Some(window) if window.continues_with(gyro_dps, accel_mps2, ts_us) => window,
            Some(_) => {
                self.refused = false;
                Window::starting_with(gyro_dps, accel_mps2, ts_us)
            }
            None => Window::starting_with(gyro_dps, accel_mps2, ts_us),
        };
        let window = window.with(gyro_dps, ts_us);
        if window.samples == CHECKED_SAMPLES && window.still_mean_dps().is_none() {
            self.window = None;
        } else if window.samples < MIN_SAMPLES || age_us(window.start_us, ts_us) < MIN_SPAN_US {
            self.window = Some(window);
        } else {
            let mean_dps = window.still_mean_dps();
            let plausible = |mean_dps: &Vector3| {
                let change_dps = vector::sub(*mean_dps, stored_offset_dps);
                vector::is_within(change_dps, MAX_OFFSET_DPS)
            };
            self.bias_dps = mean_dps.filter(plausible);
            self.refused = mean_dps.is_some() && self.bias_dps.is_none();
        }
    }
}

impl Window {
    fn starting_with(gyro_dps: Vector3, accel_mps2: Vector3, ts_us: u64) -> Self {
        Self {
            start_us: ts_us,
            last_us: ts_us,
            samples: 0,
            first_gyro_dps: gyro_dps,
            first_accel_mps2: accel_mps2,
            sum_dps: [0.0; 3],
            sum_squares: [0.0; 3],
        }
    }

    fn continues_with(&self, gyro_dps: Vector3, accel_mps2: Vector3, ts_us: u64) -> bool {
        let gravity_error = (vector::norm(accel_mps2) - GRAVITY_MPS2).abs();
        let turned = vector::sub(gyro_dps, self.first_gyro_dps);
        let pushed = vector::sub(accel_mps2, self.first_accel_mps2);
        vector::is_within(turned, MAX_GYRO_EXCURSION_DPS)
            && vector::is_within(pushed, MAX_ACCEL_EXCURSION_MPS2)
            && gravity_error < MAX_GRAVITY_ERROR_MPS2
            && age_us(self.last_us, ts_us) < MAX_PAUSE_US
            && ts_us > self.last_us
    }

    fn with(mut self, gyro_dps: Vector3, ts_us: u64) -> Self {
        let offset = vector::sub(gyro_dps, self.first_gyro_dps);
        self.sum_dps = vector::add(self.sum_dps, offset);
        self.sum_squares = vector::add(self.sum_squares, vector::multiply(offset, offset));
        self.samples = self.samples.saturating_add(1);
        self.last_us = ts_us;
        self
    }

    /// The mean rate, or `None` if its variance is too large for a robot that stands still or rotates evenly.
    fn still_mean_dps(&self) -> Option<Vector3> {
        let inverse = 1.0 / f32::from(self.samples);
        let mean_offset = vector::scale(self.sum_dps, inverse);
        let variance = vector::sub(
            vector::scale(self.sum_squares, inverse),
            vector::multiply(mean_offset, mean_offset),
        );
        let mean = vector::add(self.first_gyro_dps, mean_offset);
        let quiet = variance
            .iter()
            .all(|&value| value < MAX_GYRO_STD_DPS * MAX_GYRO_STD_DPS);
        quiet.then_some(mean)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LEVEL: Vector3 = [0.0, 0.0, 9.81];

    fn feed_still(bias: &mut StartupGyroBias, samples: u64, from_us: u64, rate: Vector3) {
        for index in 0..samples {
            let ripple = if index % 2 == 0 { 0.1 } else { -0.1 };
            bias.feed(
                vector::add(rate, [ripple, -ripple, ripple]),
                LEVEL,
                [0.0; 3],
                from_us + index * 5_000,
            );
        }
    }

    #[test]
    fn one_still_second_gives_the_mean() {
        let mut bias = StartupGyroBias::default();
        feed_still(&mut bias, 200, 1, [0.5, -0.7, 0.2]);
        assert_eq!(bias.bias_dps(), None, "0.995 s are not a second");
        feed_still(&mut bias, 1, 1 + 200 * 5_000, [0.5, -0.7, 0.2]);
        let found = bias.bias_dps().unwrap();
        for (got, expected) in found.iter().zip([0.5, -0.7, 0.2]) {
            assert!((got - expected).abs() < 2e-3, "{found:?}");
        }
    }

    #[test]
    fn a_bump_starts_the_second_again() {
        let mut bias = StartupGyroBias::default();
        feed_still(&mut bias, 150, 1, [0.0; 3]);
        bias.feed([10.0, 0.0, 0.0], LEVEL, [0.0; 3], 1 + 150 * 5_000);
        feed_still(&mut bias, 199, 1 + 151 * 5_000, [0.0; 3]);
        assert_eq!(bias.bias_dps(), None);
        feed_still(&mut bias, 3, 1 + 350 * 5_000, [0.0; 3]);
        assert!(bias.bias_dps().is_some());
    }

    #[test]
    fn a_robot_that_comes_to_rest_does_not_wait_for_the_end_of_its_second() {
        let mut bias = StartupGyroBias::default();
        for index in 0..40u32 {
            let rocking_dps = 2.0 * (0.2 * index as f32).sin();
            let ts_us = 1 + u64::from(index) * 5_000;
            bias.feed([0.0, rocking_dps, 0.0], LEVEL, [0.0; 3], ts_us);
        }
        feed_still(&mut bias, 215, 1 + 40 * 5_000, [0.0; 3]);
        assert!(bias.bias_dps().is_some());
    }

    #[test]
    fn a_shaking_or_falling_or_turning_robot_is_not_still() {
        let mut shaking = StartupGyroBias::default();
        let mut falling = StartupGyroBias::default();
        let mut turning = StartupGyroBias::default();
        for index in 0..2_000u64 {
            let ts_us = 1 + index * 5_000;
            let swing = if index % 2 == 0 { 1.0 } else { -1.0 };
            shaking.feed([swing, 0.0, 0.0], LEVEL, [0.0; 3], ts_us);
            falling.feed([0.0; 3], [0.0, 0.0, 0.5], [0.0; 3], ts_us);
            turning.feed([0.0, 0.0, 20.0], LEVEL, [0.0; 3], ts_us);
        }
        assert_eq!(shaking.bias_dps(), None);
        assert_eq!(falling.bias_dps(), None);
        assert_eq!(turning.bias_dps(), None);
    }
}
