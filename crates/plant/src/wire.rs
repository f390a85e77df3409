//! What crosses a wire between the board and a device: CAN frames, UART characters, chip selects.

use crate::time::Ps;

/// One CAN 2.0 frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CanFrame {
    /// 11 bits, or 29 where `extended`.
    pub id: u32,
    /// The identifier has 29 bits.
    pub extended: bool,
    /// A remote frame (RTR): it asks for data and carries none.
    pub remote: bool,
    /// 0 to 8.
    pub dlc: u8,
    /// The first `dlc` bytes count. A remote frame sends none of them.
    pub data: [u8; 8],
}

impl CanFrame {
    /// A data frame with a standard identifier and eight bytes.
    pub const fn with_data(id: u32, data: [u8; 8]) -> Self {
        Self {
            id,
            extended: false,
            remote: false,
            dlc: 8,
            data,
        }
    }
}

/// The parity bit of a UART character.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Parity {
    /// No parity bit.
    None,
    /// The ones of data and parity bit are even in number.
    Even,
    /// The ones of data and parity bit are odd in number.
    Odd,
}

/// How a UART transmitter shapes a character. The polarity is that of the MCU's pin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LineFormat {
    /// Bits per second.
    pub baud: u32,
    /// Data bits, without parity.
    pub data_bits: u8,
    /// The bit after the data bits.
    pub parity: Parity,
    /// 1 or 2.
    pub stop_bits: u8,
}

/// One character on a UART line, from the falling edge of its start bit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct UartChar {
    /// Falling edge of the start bit.
    pub start: Ps,
    /// The data bits.
    pub byte: u8,
    /// How it was sent, which a receiver set up otherwise gets wrong.
    pub format: LineFormat,
}

/// The two dies of the BMI088 behind one SPI bus, each with a chip select of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpiSelect {
    /// Accelerometer, chip select at PA4.
    Accel,
    /// Gyroscope, chip select at PB0.
    Gyro,
}

/// The CAN buses of the board.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CanBusId {
    /// Wheels: both C620.
    Can1,
    /// Leg joints.
    Can2,
}
