use crate::time::Ps;

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
