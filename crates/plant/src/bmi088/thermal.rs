//! Temperature of the package on its heated copper island.

/// Assumed temperature of a board that its other chips have warmed, without heater.
const WARM_BOARD_C: f64 = 30.0;
/// Temperature of a package that its heater has held until a moment ago.
const WARM_PACKAGE_C: f64 = 40.0;
/// Heater of the C board: 43 Ω on 5 V.
const HEATER_W: f64 = 0.58;
/// An assumption: full power then ends 25 K above the board.
const KELVIN_PER_WATT: f64 = 43.0;
/// An assumption.
const TIME_CONSTANT_S: f64 = 15.0;

#[derive(Clone, Copy, Debug)]
pub(super) struct Thermal {
    /// Duty cycle of the heater, 0 … 1.
    pub(super) heater_duty: f64,
    board_c: f64,
    temperature_c: f64,
}

impl Thermal {
    /// A package that is colder than a warm board sits on a board of its own temperature.
    pub(super) fn new(temperature_c: Option<f64>) -> Self {
        let temperature_c = temperature_c.unwrap_or(WARM_PACKAGE_C);
        Self {
            heater_duty: 0.0,
            board_c: WARM_BOARD_C.min(temperature_c),
            temperature_c,
        }
    }

    pub(super) fn temperature_c(&self) -> f64 {
        self.temperature_c
    }

    /// The board around the package.
    pub(super) fn board_c(&self) -> f64 {
        self.board_c
    }

    pub(super) fn step(&mut self, dt_s: f64) {
        let goal_c = self.board_c + self.heater_duty * HEATER_W * KELVIN_PER_WATT;
        self.temperature_c += (goal_c - self.temperature_c) * dt_s / TIME_CONSTANT_S;
    }
}
