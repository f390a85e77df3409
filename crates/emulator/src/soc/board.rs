//! The interface to the board at the chip's pins and buses.

use std::any::Any;

use crate::{
    soc::{
        board_errors::BoardErrors,
        flash_cells::FlashCells,
        pins::{Pin, PinBank},
        signals::{Route, Signal},
        wave::Wave,
    },
    time::Ps,
    wire::{CanFrame, CanPort, LineEvent, UartChar, UartPort},
};

/// A board with the chip on it. Every default is that of a pin or bus to which nothing is connected.
pub trait Board: Any {
    /// The cells of flash sectors 1–3.
    fn flash_cells(&mut self) -> &mut dyn FlashCells;

    /// Frequency of the crystal at OSC_IN and OSC_OUT, Hz.
    fn hse_hz(&self) -> u32;

    /// Time of the next event on the board that the chip does not cause.
    fn next_event(&self) -> Ps {
        Ps::MAX
    }

    /// Advances the board to `now`.
    fn advance(&mut self, _now: Ps) {}

    /// Reports the accesses since the last call that exceeded the limits of the board's devices.
    fn file_errors(&mut self, _errors: &mut BoardErrors, _now: Ps) {}

    /// Sets the pins' connections on the board at power-on.
    fn connect(&self, _pins: &mut PinBank) {}

    /// Sets the levels that the board's devices drive now.
    fn drive_pins(&self, _pins: &mut PinBank) {}

    /// Whether a device on the board ever drives the pin.
    fn drives(&self, _pin: Pin) -> bool {
        false
    }

    /// Called when the chip may drive its pins differently.
    fn outputs_changed(&mut self, _outputs: &Outputs<'_>, _errors: &mut BoardErrors, _now: Ps) {}

    /// The pin to which the board routes a peripheral's signal; `None` if it is not connected.
    fn route(&self, _signal: Signal) -> Option<Route> {
        None
    }

    /// The source at an analogue input.
    fn analog(&self, _signal: Signal) -> AnalogSource {
        AnalogSource::default()
    }

    /// Supply and reference of the converters, V.
    fn vdda_v(&self) -> f64 {
        3.3
    }

    /// Temperature of the chip's die, °C.
    fn chip_temperature_c(&self) -> f64 {
        25.0
    }

    /// Exchanges one byte on SPI1 in the SPI mode 0 … 3. Returns 0xFF if no device is selected.
    fn spi_transfer(&mut self, _mosi: u8, _sck_hz: u32, _mode: u8, _now: Ps) -> u8 {
        0xFF
    }

    /// A transfer on I2C3 is about to address a device.
    fn i2c_started(&mut self, _pins: &PinBank, _errors: &mut BoardErrors, _now: Ps) {}

    /// Handles START and address byte on I2C3. Returns true if a device acknowledges.
    fn i2c_address(&mut self, _address: u8, _read: bool, _scl_hz: u32, _now: Ps) -> bool {
        false
    }

    /// Sends a data byte to the device. Returns true if it acknowledges.
    fn i2c_write(&mut self, _byte: u8, _now: Ps) -> bool {
        false
    }

    /// Receives a data byte from the device, which the chip acknowledges or not.
    fn i2c_read(&mut self, _acknowledge: bool, _now: Ps) -> u8 {
        0xFF
    }

    /// Handles STOP, or a release of both lines by the chip.
    fn i2c_stop(&mut self, _now: Ps) {}

    /// Whether a device holds SDA or SCL low.
    fn i2c_bus_held(&self) -> bool {
        false
    }

    /// What happens next on the line into a USART, if it begins at or before `now`.
    fn uart_event(&mut self, _port: UartPort, _now: Ps) -> Option<LineEvent> {
        None
    }

    /// A character left the chip: its last stop bit ends `now`.
    fn uart_sent(&mut self, _port: UartPort, _character: UartChar, _now: Ps) {}

    /// Number of nodes on the bus besides the chip. They are numbered from 0.
    fn can_nodes(&self, _port: CanPort) -> usize {
        0
    }

    /// Whether the bus is cut or shorted for every node.
    fn can_broken(&self, _port: CanPort) -> bool {
        false
    }

    /// Whether the node is powered and connected. Otherwise it neither sends nor acknowledges.
    fn can_present(&self, _port: CanPort, _node: usize) -> bool {
        false
    }

    /// Whether the node receives frames. This is true for a node that is present, and for one that only listens.
    fn can_hears(&self, port: CanPort, node: usize) -> bool {
        self.can_present(port, node)
    }

    /// The frame that the node requests to send now.
    fn can_pending(&self, _port: CanPort, _node: usize, _now: Ps) -> Option<CanFrame> {
        None
    }

    /// The node's pending frame went out and was acknowledged.
    fn can_sent(&mut self, _port: CanPort, _node: usize, _now: Ps) {}

    /// A frame of another node ended without error; called for each node that receives it.
    fn can_received(&mut self, _port: CanPort, _node: usize, _frame: &CanFrame, _now: Ps) {}
}

/// Outputs of the chip on its pins.
pub struct Outputs<'a> {
    /// Modes and levels of the ports.
    pub pins: &'a PinBank,
    /// The waves of the timers' channels.
    pub waves: &'a dyn Waves,
}

/// The waves that timers drive onto pins of an alternate function.
pub trait Waves {
    /// The wave of channel 1 … 4 of TIM4, TIM5 or TIM10; `None` while its output is off.
    fn wave(&self, timer: u8, channel: u8) -> Option<Wave>;
}

/// A voltage behind a resistance.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AnalogSource {
    /// Open-circuit voltage, V.
    pub volts: f64,
    /// Source resistance, Ω.
    pub ohms: f64,
}
