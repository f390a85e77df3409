use crate::time::{Ps, SECOND};

/// The parity bit of a UART character.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Parity {
    /// No parity bit.
    None,
    /// An even number of ones, the parity bit included.
    Even,
    /// An odd number of ones, the parity bit included.
    Odd,
}

/// How a UART transmitter shapes a character. The polarity is that of the chip's pin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LineFormat {
    /// Bits a second.
    pub baud: u32,
    /// Number of data bits, the parity bit not counted.
    pub data_bits: u8,
    /// The parity bit that follows the data.
    pub parity: Parity,
    /// 1 or 2.
    pub stop_bits: u8,
}

/// One character on a UART line, from the falling edge of its start bit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct UartChar {
    /// When its start bit begins.
    pub start: Ps,
    /// The data bits, least significant first on the line.
    pub byte: u8,
    /// How it was sent, which a receiver set up otherwise gets wrong.
    pub format: LineFormat,
}

impl LineFormat {
    /// Bits of a character on the line: start bit, data, parity and stop bits.
    pub fn bits(self) -> u32 {
        let parity = u32::from(self.parity != Parity::None);
        1 + u32::from(self.data_bits) + parity + u32::from(self.stop_bits)
    }

    /// Duration of a character, from its start edge to the end of its last stop bit.
    pub fn char_time(self) -> Ps {
        Ps::from(self.bits()) * SECOND / Ps::from(self.baud)
    }

    /// Whether a receiver set to `self` understands what was sent in the format `sent`: the same word, and a rate that
    /// differs by at most 3 %.
    pub fn understands(self, sent: Self) -> bool {
        let off = u64::from(self.baud.abs_diff(sent.baud));
        self.data_bits == sent.data_bits
            && self.parity == sent.parity
            && off * 100 <= 3 * u64::from(sent.baud)
    }
}

/// The form that the manuals use, such as `460800 8N1`.
impl std::fmt::Display for LineFormat {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let parity = match self.parity {
            Parity::None => 'N',
            Parity::Even => 'E',
            Parity::Odd => 'O',
        };
        write!(
            f,
            "{} {}{parity}{}",
            self.baud, self.data_bits, self.stop_bits
        )
    }
}

/// What a device does to a UART line next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LineEvent {
    /// It sends a character.
    Character(UartChar),
    /// It holds the line low: a break, or a glitch that is shorter than a bit.
    Low {
        /// The falling edge.
        from: Ps,
        /// The rising edge.
        until: Ps,
    },
}

impl LineEvent {
    /// The first falling edge.
    pub fn start(&self) -> Ps {
        match self {
            Self::Character(character) => character.start,
            Self::Low { from, .. } => *from,
        }
    }
}
