//! State of every GPIO pin, kept by the GPIO ports and read by whoever sits behind a pin.

/// Port A = 0 … I = 8, and the pin number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Pin {
    pub port: u8,
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

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PinMode {
    Input,
    Output,
    Alternate(u8),
    Analog,
}

/// Mode and levels of the 9 × 16 pins.
#[derive(Debug)]
pub struct PinBank {
    mode: [[PinMode; 16]; 9],
    open_drain: [[bool; 16]; 9],
    driven: [[bool; 16]; 9],
    external: [[bool; 16]; 9],
}

impl Default for PinBank {
    /// After reset: inputs, but PA13–15 and PB3–4 on AF0 (debug port); outside levels high (pulled up).
    fn default() -> Self {
        let mut mode = [[PinMode::Input; 16]; 9];
        for (port, number) in [(0, 13), (0, 14), (0, 15), (1, 3), (1, 4)] {
            mode[port][number] = PinMode::Alternate(0);
        }
        Self {
            mode,
            open_drain: [[false; 16]; 9],
            driven: [[false; 16]; 9],
            external: [[true; 16]; 9],
        }
    }
}

impl PinBank {
    pub fn mode(&self, pin: Pin) -> PinMode {
        self.mode[usize::from(pin.port)][usize::from(pin.number)]
    }

    pub fn set_mode(&mut self, pin: Pin, mode: PinMode) {
        self.mode[usize::from(pin.port)][usize::from(pin.number)] = mode;
    }

    /// True where the output stage pulls down only.
    pub fn open_drain(&self, pin: Pin) -> bool {
        self.open_drain[usize::from(pin.port)][usize::from(pin.number)]
    }

    pub fn set_open_drain(&mut self, pin: Pin, open_drain: bool) {
        self.open_drain[usize::from(pin.port)][usize::from(pin.number)] = open_drain;
    }

    /// What the output register asks for (seen outside only in output mode).
    pub fn set_driven(&mut self, pin: Pin, high: bool) {
        self.driven[usize::from(pin.port)][usize::from(pin.number)] = high;
    }

    /// What a device outside drives onto the pin.
    pub fn set_external(&mut self, pin: Pin, high: bool) {
        self.external[usize::from(pin.port)][usize::from(pin.number)] = high;
    }

    /// Level on the wire.
    pub fn level(&self, pin: Pin) -> bool {
        let (port, number) = (usize::from(pin.port), usize::from(pin.number));
        match self.mode[port][number] {
            // An open drain lets go where it does not pull down.
            PinMode::Output if self.open_drain[port][number] => {
                self.driven[port][number] && self.external[port][number]
            }
            PinMode::Output => self.driven[port][number],
            _ => self.external[port][number],
        }
    }
}
