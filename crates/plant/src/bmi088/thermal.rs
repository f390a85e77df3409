//! Temperature of the package on its heated copper island.

/// Assumed room and board without heater.
const AMBIENT_C: f64 = 30.0;
/// Heater of the C board: 43 Ω on 5 V (hardware.md 1.2).
const HEATER_W: f64 = 0.58;
/// No source gives it: chosen so that full heat ends 25 K above the board.
const KELVIN_PER_WATT: f64 = 43.0;
/// An assumption too.
const TIME_CONSTANT_S: f64 = 15.0;

#[derive(Clone, Copy, Debug)]
pub(super) struct Thermal {
    /// 0 … 1.
    pub(super) heater_duty: f64,
    temperature_c: f64,
}

impl Default for Thermal {
    fn default() -> Self {
        Self {
            heater_duty: 0.0,
            temperature_c: AMBIENT_C,
        }
    }
}

impl Thermal {
    pub(super) fn temperature_c(&self) -> f64 {
        self.temperature_c
    }

    pub(super) fn step(&mut self, dt_s: f64) {
        let goal_c = AMBIENT_C + self.heater_duty * HEATER_W * KELVIN_PER_WATT;
        self.temperature_c += (goal_c - self.temperature_c) * dt_s / TIME_CONSTANT_S;
    }
}
