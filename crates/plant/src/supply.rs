//! The 24 V battery and what the board sees of it.

/// Six cells, half charged.
const OPEN_CIRCUIT_V: f64 = 24.0;
/// 3.4 V per cell.
const LOW_V: f64 = 20.5;
/// 3.1 V per cell.
const EMPTY_V: f64 = 18.5;
/// Resistance of pack and leads; assumed.
const RESISTANCE_OHM: f64 = 0.05;
/// 200 kΩ over 22 kΩ (docs/hardware.md#board-devices).
const DIVIDER: f64 = 22.0 / 222.0;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Charge {
    Half,
    Low,
    Empty,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Battery {
    charge: Charge,
    terminal_v: f64,
}

impl Default for Battery {
    fn default() -> Self {
        Self {
            charge: Charge::Half,
            terminal_v: OPEN_CIRCUIT_V,
        }
    }
}

impl Battery {
    pub(crate) fn set_charge(&mut self, charge: Charge) {
        self.charge = charge;
    }

    /// Lets the voltage sag under the mechanical power of the motors, W, negative while they brake.
    pub(crate) fn load(&mut self, power_w: f64) {
        let open_v = match self.charge {
            Charge::Half => OPEN_CIRCUIT_V,
            Charge::Low => LOW_V,
            Charge::Empty => EMPTY_V,
        };
        self.terminal_v = open_v - RESISTANCE_OHM * power_w / open_v;
    }

    pub(crate) fn volts(&self) -> f64 {
        self.terminal_v
    }

    /// Voltage at PF10.
    pub(crate) fn adc_volts(&self) -> f64 {
        self.terminal_v * DIVIDER
    }
}
