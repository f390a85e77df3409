//! What crosses a wire between the board and a device.

use crate::time::Ps;

/// One CAN 2.0 frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CanFrame {
    /// 11 bits, or 29 where `extended`.
    pub id: u32,
    pub extended: bool,
    /// Asks for the data (RTR) instead of carrying them.
    pub remote: bool,
    /// 0 to 8.
    pub dlc: u8,
    /// The first `dlc` bytes; none of a remote frame reach the wire.
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

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Parity {
    None,
    Even,
    Odd,
}

/// How a UART transmitter shapes a character (polarity as it arrives at the MCU pin).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LineFormat {
    pub baud: u32,
    pub data_bits: u8,
    pub parity: Parity,
    /// 1 or 2.
    pub stop_bits: u8,
}

/// One character on a UART line, from the falling edge of its start bit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct UartChar {
    pub start: Ps,
    pub byte: u8,
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
