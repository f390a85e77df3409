//! Signals of the peripherals, and their connections on a board.

use crate::soc::pins::{Pin, PinMode};

/// A peripheral's signal that a board can route to a device or connector.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Signal {
    /// SPI1 clock.
    Spi1Sck,
    /// SPI1 data into the chip.
    Spi1Miso,
    /// SPI1 data out of the chip.
    Spi1Mosi,
    /// I2C3 clock.
    I2c3Scl,
    /// I2C3 data.
    I2c3Sda,
    /// USART1 transmit data.
    Usart1Tx,
    /// USART1 receive data.
    Usart1Rx,
    /// USART3 receive data.
    Usart3Rx,
    /// USART6 transmit data.
    Usart6Tx,
    /// USART6 receive data.
    Usart6Rx,
    /// CAN1 transmit data.
    Can1Tx,
    /// CAN1 receive data.
    Can1Rx,
    /// CAN2 transmit data.
    Can2Tx,
    /// CAN2 receive data.
    Can2Rx,
    /// Input 8 of ADC3.
    Adc3In8,
}

impl Signal {
    /// The signal's name in the datasheet.
    pub fn name(self) -> &'static str {
        match self {
            Self::Spi1Sck => "SPI1_SCK",
            Self::Spi1Miso => "SPI1_MISO",
            Self::Spi1Mosi => "SPI1_MOSI",
            Self::I2c3Scl => "I2C3_SCL",
            Self::I2c3Sda => "I2C3_SDA",
            Self::Usart1Tx => "USART1_TX",
            Self::Usart1Rx => "USART1_RX",
            Self::Usart3Rx => "USART3_RX",
            Self::Usart6Tx => "USART6_TX",
            Self::Usart6Rx => "USART6_RX",
            Self::Can1Tx => "CAN1_TX",
            Self::Can1Rx => "CAN1_RX",
            Self::Can2Tx => "CAN2_TX",
            Self::Can2Rx => "CAN2_RX",
            Self::Adc3In8 => "ADC3_IN8",
        }
    }

    /// The pin mode that carries it (DS8626 table 9).
    pub fn mode(self) -> PinMode {
        match self {
            Self::I2c3Scl | Self::I2c3Sda => PinMode::Alternate(4),
            Self::Spi1Sck | Self::Spi1Miso | Self::Spi1Mosi => PinMode::Alternate(5),
            Self::Usart1Tx | Self::Usart1Rx | Self::Usart3Rx => PinMode::Alternate(7),
            Self::Usart6Tx | Self::Usart6Rx => PinMode::Alternate(8),
            Self::Can1Tx | Self::Can1Rx | Self::Can2Tx | Self::Can2Rx => PinMode::Alternate(9),
            Self::Adc3In8 => PinMode::Analog,
        }
    }
}

/// Requirement of a signal on its pin's output stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// The board drives the pin.
    None,
    /// Edges of a few ns to 100 ns: push-pull.
    Fast,
    /// Bits of several µs: push-pull, or open-drain with a pull-up.
    Slow,
    /// Others pull the line down too: open-drain.
    Shared,
}

/// The board's connection of a signal.
#[derive(Clone, Copy, Debug)]
pub struct Route {
    /// The pin that the board has connected.
    pub pin: Pin,
    /// The output stage that can drive the line.
    pub stage: Stage,
    /// The consequence when the signal does not get through, as the end of an error message.
    pub consequence: &'static str,
}
