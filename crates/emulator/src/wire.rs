//! Frames and characters on the wires between the chip and its board.

use crate::time::Ps;

/// One CAN 2.0 frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CanFrame {
    /// Identifier of 11 bits, or of 29 bits if `extended`.
    pub id: u32,
    /// The identifier has 29 bits (IDE).
    pub extended: bool,
    /// The frame requests data (RTR) instead of carrying them.
    pub remote: bool,
    /// Number of data bytes, 0 to 8.
    pub dlc: u8,
    /// The first `dlc` bytes are sent; none of a remote frame.
    pub data: [u8; 8],
}

/// The CAN controller of a bus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CanPort {
    /// bxCAN 1, the master of the shared filters.
    Can1,
    /// bxCAN 2.
    Can2,
}

/// Parity bit of a UART character.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Parity {
    /// No parity bit.
    None,
    /// An even number of ones, the parity bit included.
    Even,
    /// An odd number of ones, the parity bit included.
    Odd,
}

/// How a UART transmitter shapes a character (polarity as it arrives at the chip's pin).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LineFormat {
    /// Bits a second.
    pub baud: u32,
    /// Number of data bits, the parity bit not counted.
    pub data_bits: u8,
    /// The parity bit that follows the data.
    pub parity: Parity,
    /// Number of stop bits, 1 or 2.
    pub stop_bits: u8,
}

/// One character on a UART line, from the falling edge of its start bit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct UartChar {
    /// Time at which its start bit begins.
    pub start: Ps,
    /// The data bits, least significant first on the line.
    pub byte: u8,
    /// How the transmitter shapes it.
    pub format: LineFormat,
}
