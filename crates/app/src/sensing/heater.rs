//! PI control of the IMU's heater. A steady temperature keeps the gyro bias steady.
//!
//! The heater is off while the temperature is not known or too high. `docs/sensors.md` lists all cases.

use crate::{
    domain::{HeaterConfig, HeaterState, HeaterStatus, age_us},
    math::scalar,
};

/// Largest distance from the target at which the package is warm.
pub(super) const NEAR_TARGET_K: f32 = 3.0;
/// A target below this switches the heater off.
const MIN_TARGET_C: f32 = 20.0;
/// The heater is cut off this far above the target, or above `MAX_C`, until the temperature has fallen to the target.
const MAX_ABOVE_TARGET_K: f32 = 10.0;
const MAX_C: f32 = 65.0;
/// Operating range of the BMI088 (datasheet, table 1). A value outside is not valid.
const VALID_C: core::ops::RangeInclusive<f32> = -40.0..=85.0;
/// Longest time step of the integral.
const MAX_STEP_US: u32 = 20_000;

/// The heater's controller. It is stepped with every sample, with or without a temperature.
#[derive(Clone, Debug)]
pub struct Heater {
    config: HeaterConfig,
    /// Integral part of the duty.
    integral: f32,
    too_hot: bool,
    stepped_us: u64,
    status: HeaterStatus,
}

impl Heater {
    pub fn new(config: HeaterConfig) -> Self {
        Self {
            config,
            integral: 0.0,
            too_hot: false,
            stepped_us: 0,
            status: HeaterStatus::default(),
        }
    }

    /// Changes the settings from the next step on.
    pub fn set_config(&mut self, config: &HeaterConfig) {
        self.config = *config;
    }

    /// State, temperature and duty after the last step.
    pub const fn status(&self) -> &HeaterStatus {
        &self.status
    }

    /// The temperature to hold.
    pub const fn target_c(&self) -> f32 {
        self.config.target_c
    }

    /// True while the duty is at a limit, so that the heater cannot give more or less.
    pub fn at_limit(&self) -> bool {
        self.status.duty <= 0.0 || self.status.duty >= self.max_duty()
    }

    /// Computes the duty for the next interval. `temperature_c` is `None` if it was not read or the sensor marks it
    /// invalid.
    pub fn step(&mut self, temperature_c: Option<f32>, ts_us: u64) {
        let dt_us = age_us(self.stepped_us, ts_us).min(MAX_STEP_US);
        self.stepped_us = ts_us;
        let valid = temperature_c.filter(|celsius| VALID_C.contains(celsius));
        if let Some(celsius) = valid {
            self.status.temperature_c = celsius;
        }
        (self.status.state, self.status.duty) = self.decide(valid, dt_us as f32 * 1e-6);
    }

    fn decide(&mut self, temperature_c: Option<f32>, dt_s: f32) -> (HeaterState, f32) {
        let target_c = self.config.target_c;
        if target_c.is_nan() || target_c < MIN_TARGET_C {
            self.integral = 0.0;
            return (HeaterState::Off, 0.0);
        }
        let Some(celsius) = temperature_c else {
            return (HeaterState::CutOff, 0.0);
        };
        let limit_c = (target_c + MAX_ABOVE_TARGET_K).min(MAX_C);
        self.too_hot = celsius > limit_c || (self.too_hot && celsius > target_c);
        if self.too_hot {
            self.integral = 0.0;
            return (HeaterState::CutOff, 0.0);
        }
        let error_k = target_c - celsius;
        let state = if error_k > NEAR_TARGET_K {
            HeaterState::Heating
        } else {
            HeaterState::Holding
        };
        let duty = self.control(error_k, dt_s);
        if duty.is_finite() && self.integral.is_finite() {
            (state, duty)
        } else {
            self.integral = 0.0;
            (HeaterState::CutOff, 0.0)
        }
    }

    fn control(&mut self, error_k: f32, dt_s: f32) -> f32 {
        let max_duty = self.max_duty();
        let wanted = self.config.kp * error_k + self.integral;
        let winds_up = (wanted >= max_duty && error_k > 0.0) || (wanted <= 0.0 && error_k < 0.0);
        if !winds_up {
            let grown = self.integral + self.config.ki * error_k * dt_s;
            self.integral = scalar::clamp(grown, 0.0, max_duty);
        }
        scalar::clamp(wanted, 0.0, max_duty)
    }

    /// The largest duty; 0 if the setting is NaN.
    fn max_duty(&self) -> f32 {
        if self.config.max_duty > 0.0 {
            self.config.max_duty.min(1.0)
        } else {
            0.0
        }
    }
}

#[cfg(test)]
mod tests;
