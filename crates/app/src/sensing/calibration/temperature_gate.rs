//! Whether the package is as warm as it will get, so that a gyro bias measured now stays valid.

use super::super::heater::{Heater, NEAR_TARGET_K};
use crate::domain::{HeaterState, TemperatureGateState, age_us};

/// A heater that has been at a limit for this long cannot reach the target.
const AT_LIMIT_US: u32 = 15_000_000;
/// Largest change of a steady temperature.
const STEADY_K: f32 = 0.3;
/// Time for which it must be steady.
const STEADY_US: u32 = 5_000_000;
/// Time without any valid temperature after which the calibration goes on without one.
const UNKNOWN_AFTER_US: u32 = 20_000_000;

#[derive(Clone, Copy, Debug)]
struct Reading {
    celsius: f32,
    ts_us: u64,
}

/// Decides the warmth of the package. To be stepped with every sample.
#[derive(Clone, Debug, Default)]
pub struct TemperatureGate {
    /// Time of the last valid temperature, or of the first sample if there was none.
    known_us: Option<u64>,
    /// The reading since which the temperature has been steady.
    steady_from: Option<Reading>,
    at_limit_since_us: Option<u64>,
}

impl TemperatureGate {
    /// `temperature_c` and `heater` are those of this sample.
    pub fn step(
        &mut self,
        temperature_c: Option<f32>,
        heater: &Heater,
        ts_us: u64,
    ) -> TemperatureGateState {
        let known_us = *self.known_us.get_or_insert(ts_us);
        let Some(celsius) = temperature_c else {
            return if age_us(known_us, ts_us) >= UNKNOWN_AFTER_US {
                TemperatureGateState::Unknown
            } else {
                TemperatureGateState::Unsettled
            };
        };
        self.known_us = Some(ts_us);
        let steady = self.is_steady(celsius, ts_us);
        let at_limit = self.is_at_limit(heater, ts_us);
        if heater.status().state == HeaterState::Off {
            return if steady {
                TemperatureGateState::Settled
            } else {
                TemperatureGateState::Unsettled
            };
        }
        if (celsius - heater.target_c()).abs() <= NEAR_TARGET_K {
            TemperatureGateState::AtTarget
        } else if steady && at_limit {
            TemperatureGateState::Settled
        } else {
            TemperatureGateState::Unsettled
        }
    }

    fn is_steady(&mut self, celsius: f32, ts_us: u64) -> bool {
        let reading = Reading { celsius, ts_us };
        let from = self.steady_from.get_or_insert(reading);
        if (celsius - from.celsius).abs() >= STEADY_K {
            *from = reading;
        }
        age_us(from.ts_us, ts_us) >= STEADY_US
    }

    fn is_at_limit(&mut self, heater: &Heater, ts_us: u64) -> bool {
        if !heater.at_limit() {
            self.at_limit_since_us = None;
            return false;
        }
        let since_us = *self.at_limit_since_us.get_or_insert(ts_us);
        age_us(since_us, ts_us) >= AT_LIMIT_US
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::domain::HeaterConfig;

    /// The warmth after each whole second, at 50 Hz. `celsius` gives the temperature at a time in s.
    fn warmth(
        config: HeaterConfig,
        celsius: impl Fn(f32) -> Option<f32>,
    ) -> Vec<TemperatureGateState> {
        let mut gate = TemperatureGate::default();
        let mut heater = Heater::new(config);
        let mut each_second = Vec::new();
        for tick in 0..=3_000u64 {
            let ts_us = 1 + tick * 20_000;
            let temperature = celsius(tick as f32 / 50.0);
            heater.step(temperature, ts_us);
            let warmth = gate.step(temperature, &heater, ts_us);
            if tick % 50 == 0 {
                each_second.push(warmth);
            }
        }
        each_second
    }

    fn first(warmths: &[TemperatureGateState], wanted: TemperatureGateState) -> Option<usize> {
        warmths.iter().position(|warmth| *warmth == wanted)
    }

    /// At one kelvin per second, 22 °C come within 3 K of 40 °C after 15 s.
    #[test]
    fn a_temperature_near_the_target_is_accepted_at_once() {
        let warmths = warmth(HeaterConfig::default(), |t| Some((22.0 + t).min(40.0)));
        assert_eq!(first(&warmths, TemperatureGateState::AtTarget), Some(15));
        let warm = warmth(HeaterConfig::default(), |_| Some(38.0));
        assert_eq!(first(&warm, TemperatureGateState::AtTarget), Some(0));
    }

    /// On USB the heater ends at 34 °C. With a time constant of 4 s from 24 °C, the temperature moves by less than 0.3
    /// K in 5 s from 13 s on: 10 K · e^(−13/4) = 0.39 K are left then, 0.11 K at 18 s.
    #[test]
    fn a_heater_that_cannot_reach_the_target_is_accepted_once_steady() {
        let usb = |t: f32| Some(34.0 - 10.0 * (-t / 4.0).exp());
        let warmths = warmth(HeaterConfig::default(), usb);
        let settled = first(&warmths, TemperatureGateState::Settled).unwrap();
        assert!((15..=20).contains(&settled), "{settled}");
        assert_eq!(first(&warmths, TemperatureGateState::AtTarget), None);
    }

    #[test]
    fn a_moving_temperature_is_not_accepted() {
        let drifting = warmth(HeaterConfig::default(), |t| Some(10.0 + 0.1 * t));
        assert!(
            drifting
                .iter()
                .all(|warmth| *warmth == TemperatureGateState::Unsettled)
        );
    }

    /// 3.5 K below the target the duty is 0.7, and grows by 0.035 a second. It reaches its limit after 9 s; the gate
    /// waits for 15 s more.
    #[test]
    fn a_heater_below_its_limit_is_waited_for() {
        let warmths = warmth(HeaterConfig::default(), |_| Some(36.5));
        let settled = first(&warmths, TemperatureGateState::Settled).unwrap();
        assert!((23..=26).contains(&settled), "{settled}");
    }

    #[test]
    fn without_heater_a_steady_temperature_is_enough() {
        let off = HeaterConfig {
            target_c: 0.0,
            ..HeaterConfig::default()
        };
        let warmths = warmth(off, |_| Some(25.0));
        assert_eq!(first(&warmths, TemperatureGateState::Settled), Some(5));
    }

    #[test]
    fn without_temperature_it_goes_on_after_twenty_seconds() {
        let warmths = warmth(HeaterConfig::default(), |_| None);
        assert_eq!(first(&warmths, TemperatureGateState::Unknown), Some(20));
        let back = warmth(HeaterConfig::default(), |t| (t > 30.0).then_some(22.0));
        assert_eq!(
            back[31],
            TemperatureGateState::Unsettled,
            "it is waited for again"
        );
        let lost = warmth(HeaterConfig::default(), |t| (t < 30.0).then_some(22.0));
        assert_eq!(
            lost[49],
            TemperatureGateState::Unsettled,
            "20 s from the last one"
        );
        assert_eq!(lost[50], TemperatureGateState::Unknown);
    }
}
