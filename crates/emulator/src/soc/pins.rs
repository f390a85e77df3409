//! State of every GPIO pin, kept by the GPIO ports and read by the devices behind the pins.

/// Port A = 0 … I = 8, and the pin number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Pin {
    /// Port A = 0 … I = 8.
    pub port: u8,
    /// 0 … 15.
    pub number: u8,
}

impl Pin {
    /// `Pin::new('B', 3)` is PB3.
    pub const fn new(port: char, number: u8) -> Self {
        Self {
            port: port as u8 - b'A',
            number,
        }
    }
}

impl std::fmt::Display for Pin {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "P{}{}", char::from(b'A' + self.port), self.number)
    }
}

/// Function of a pin (MODER and AFR).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PinMode {
    /// Digital input.
    Input,
    /// The output register drives it.
    Output,
    /// A peripheral uses it, by number of the alternate function.
    Alternate(u8),
    /// Analogue input or output.
    Analog,
}

impl std::fmt::Display for PinMode {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Input => f.write_str("an input"),
            Self::Output => f.write_str("an output"),
            Self::Alternate(number) => write!(f, "AF{number}"),
            Self::Analog => f.write_str("analog"),
        }
    }
}

/// The chip's own resistor of some 40 kΩ.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pull {
    /// No resistor.
    None,
    /// Pull-up to VDD.
    Up,
    /// Pull-down to ground.
    Down,
}

/// Settings of a pin in its port's registers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PinSettings {
    /// MODER, with AFR.
    pub mode: PinMode,
    /// The output stage pulls down only.
    pub open_drain: bool,
    /// PUPDR.
    pub pull: Pull,
    /// OSPEEDR, 0 … 3.
    pub speed: u8,
    /// ODR: the level that the pin drives in output mode.
    pub high: bool,
}

impl PinSettings {
    /// The state after reset, except for the debug port's pins.
    pub const RESET: Self = Self {
        mode: PinMode::Input,
        open_drain: false,
        pull: Pull::None,
        speed: 0,
        high: false,
    };
}

/// Connection of a pin on the board.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ExternalConnection {
    /// Nothing outside the chip gives the pin a level.
    #[default]
    Nothing,
    /// A resistor of some kΩ to 3.3 V, which wins over the chip's own.
    PullUp,
    /// A device drives it.
    Drives(bool),
}

/// Settings and levels of the 9 × 16 pins.
#[derive(Debug)]
pub struct PinBank {
    settings: [[PinSettings; 16]; 9],
    outside: [[ExternalConnection; 16]; 9],
}

impl Default for PinBank {
    /// The state after reset: inputs, except for PA13–15 and PB3–4 on AF0 (debug port). Nothing is connected.
    fn default() -> Self {
        let mut settings = [[PinSettings::RESET; 16]; 9];
        for (port, number) in [(0, 13), (0, 14), (0, 15), (1, 3), (1, 4)] {
            settings[port][number].mode = PinMode::Alternate(0);
        }
        Self {
            settings,
            outside: [[ExternalConnection::Nothing; 16]; 9],
        }
    }
}

impl PinBank {
    /// The pin's settings.
    pub fn settings(&self, pin: Pin) -> PinSettings {
        self.settings[usize::from(pin.port)][usize::from(pin.number)]
    }

    /// Sets the pin up as the port's registers say.
    pub fn set(&mut self, pin: Pin, settings: PinSettings) {
        self.settings[usize::from(pin.port)][usize::from(pin.number)] = settings;
    }

    /// The pin's function.
    pub fn mode(&self, pin: Pin) -> PinMode {
        self.settings(pin).mode
    }

    /// The pin's connection on the board.
    pub fn outside(&self, pin: Pin) -> ExternalConnection {
        self.outside[usize::from(pin.port)][usize::from(pin.number)]
    }

    /// Changes the pin's connection on the board.
    pub fn connect(&mut self, pin: Pin, outside: ExternalConnection) {
        self.outside[usize::from(pin.port)][usize::from(pin.number)] = outside;
    }

    /// Level on the wire; `None` if no output and no resistor sets one. The output of a peripheral on a pin with an
    /// alternate function is not included.
    pub fn level(&self, pin: Pin) -> Option<bool> {
        let settings = self.settings(pin);
        if settings.mode == PinMode::Output && !(settings.open_drain && settings.high) {
            return Some(settings.high);
        }
        match (self.outside(pin), settings.pull) {
            (ExternalConnection::Drives(high), _) => Some(high),
            (ExternalConnection::PullUp, _) | (ExternalConnection::Nothing, Pull::Up) => Some(true),
            (ExternalConnection::Nothing, Pull::Down) => Some(false),
            (ExternalConnection::Nothing, Pull::None) => None,
        }
    }

    /// Whether two outputs conflict: the pin drives one level and a device outside the other.
    pub fn contested(&self, pin: Pin) -> bool {
        let settings = self.settings(pin);
        settings.mode == PinMode::Output
            && self.outside(pin) == ExternalConnection::Drives(!settings.high)
            && !(settings.open_drain && settings.high)
    }
}
