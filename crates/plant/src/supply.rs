//! The 24 V battery and what the board sees of it.

/// Six cells, half charged.
const OPEN_CIRCUIT_V: f64 = 24.0;
/// Under the 3.3 V a cell of a spent pack.
const SPENT_V: f64 = 19.2;
/// Pack and leads; assumed.
const RESISTANCE_OHM: f64 = 0.05;
/// 200 kΩ over 22 kΩ (hardware.md 1.2).
const DIVIDER: f64 = 22.0 / 222.0;

#[derive(Clone, Copy, Debug)]
pub(crate) struct Battery {
    spent: bool,
    terminal_v: f64,
}

impl Default for Battery {
    fn default() -> Self {
        Self {
            spent: false,
            terminal_v: OPEN_CIRCUIT_V,
        }
    }
}

impl Battery {
    pub(crate) fn set_spent(&mut self, spent: bool) {
        self.spent = spent;
    }

    /// Sags under the mechanical power of the motors, W (negative while they brake).
    pub(crate) fn load(&mut self, power_w: f64) {
        let open_v = if self.spent { SPENT_V } else { OPEN_CIRCUIT_V };
        self.terminal_v = open_v - RESISTANCE_OHM * power_w / open_v;
    }

    pub(crate) fn volts(&self) -> f64 {
        self.terminal_v
    }

    /// At PF10.
    pub(crate) fn adc_volts(&self) -> f64 {
        self.terminal_v * DIVIDER
    }
}
