//! What crosses a wire between the board and a device: CAN frames, UART characters, chip selects.

pub use robot_wire::{CanFrame, LineEvent, LineFormat, Parity, UartChar};

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
