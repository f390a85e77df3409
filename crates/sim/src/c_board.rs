//! The RoboMaster Development Board C around the chip: its schematic (user manual and schematic of the board), with the
//! simulated world on its connectors.

mod nets;
mod outputs;
mod routes;
mod wires;

use robot_emulator::{
    soc::{
        board::{AnalogSource, Board, Outputs},
        board_errors::BoardErrors,
        flash_cells::FlashCells,
        pins::{Pin, PinBank},
        signals::{Route, Signal},
    },
    time::Ps,
    wire::{CanFrame, CanPort, LineEvent, UartChar, UartPort},
};
use robot_plant::{complaint::Severity, flash_chip::FlashChip, world::World};

use outputs::Levels;
use wires::bus_id;

/// The battery's divider, 200 kΩ over 22 kΩ, as the converter sees it.
const BATTERY_DIVIDER_OHMS: f64 = 19_820.0;

/// The board, the cells of the chip's flash, and the world.
pub struct CBoard {
    pub world: World,
    /// Sectors 1–3.
    pub flash: FlashChip,
    /// The levels that were last passed to the devices, so that only changes are passed.
    levels: Option<Levels>,
}

impl CBoard {
    pub fn new(world: World) -> Self {
        Self {
            world,
            flash: FlashChip::parameters(0),
            levels: None,
        }
    }
}

impl Board for CBoard {
    fn flash_cells(&mut self) -> &mut dyn FlashCells {
        self
    }

    /// The crystal of `docs/hardware.md#chip-and-clocks`.
    fn hse_hz(&self) -> u32 {
        12_000_000
    }

    fn next_event(&self) -> Ps {
        self.world.next_event()
    }

    fn advance(&mut self, now: Ps) {
        self.world.advance(now);
    }

    fn file_errors(&mut self, errors: &mut BoardErrors, now: Ps) {
        for complaint in self.world.take_complaints() {
            match complaint.severity {
                Severity::Fails => errors.report(now, complaint.text),
                Severity::Suspicious => errors.suspect(now, complaint.text),
            }
        }
    }

    fn connect(&self, pins: &mut PinBank) {
        nets::connect(pins);
    }

    fn drive_pins(&self, pins: &mut PinBank) {
        nets::drive_inputs(pins, &self.world);
    }

    fn drives(&self, pin: Pin) -> bool {
        nets::drives_input(pin)
    }

    fn outputs_changed(&mut self, outputs: &Outputs<'_>, errors: &mut BoardErrors, now: Ps) {
        let levels = outputs::levels(outputs, errors, now);
        let before = self.levels.replace(levels);
        outputs::tell(&mut self.world, before, levels, now);
    }

    fn route(&self, signal: Signal) -> Option<Route> {
        Some(routes::route(signal))
    }

    fn analog(&self, _signal: Signal) -> AnalogSource {
        AnalogSource {
            volts: self.world.battery_adc_volts(),
            ohms: BATTERY_DIVIDER_OHMS,
        }
    }

    fn vdda_v(&self) -> f64 {
        self.world.vdda_v()
    }

    fn chip_temperature_c(&self) -> f64 {
        self.world.chip_temperature_c()
    }

    fn spi_transfer(&mut self, mosi: u8, sck_hz: u32, mode: u8, now: Ps) -> u8 {
        self.world.spi_transfer(mosi, sck_hz, mode, now)
    }

    fn i2c_started(&mut self, pins: &PinBank, errors: &mut BoardErrors, now: Ps) {
        outputs::check_mag_reset(pins, errors, now);
    }

    fn i2c_address(&mut self, address: u8, read: bool, scl_hz: u32, now: Ps) -> bool {
        self.world.i2c_address(address, read, scl_hz, now)
    }

    fn i2c_write(&mut self, byte: u8, now: Ps) -> bool {
        self.world.i2c_write(byte, now)
    }

    fn i2c_read(&mut self, acknowledge: bool, now: Ps) -> u8 {
        self.world.i2c_read(acknowledge, now)
    }

    fn i2c_stop(&mut self, now: Ps) {
        self.world.i2c_stop(now);
    }

    fn i2c_bus_held(&self) -> bool {
        self.world.i2c_bus_held()
    }

    /// Nothing is plugged into the 3-pin UART1, which is USART6.
    fn uart_event(&mut self, port: UartPort, now: Ps) -> Option<LineEvent> {
        match port {
            UartPort::Usart1 => self.world.link_event(now),
            UartPort::Usart3 => self.world.radio_char(now).map(LineEvent::Character),
            UartPort::Usart6 => None,
        }
    }

    fn uart_sent(&mut self, port: UartPort, character: UartChar, now: Ps) {
        if port == UartPort::Usart1 {
            self.world.link_sent(character, now);
        }
    }

    fn can_nodes(&self, port: CanPort) -> usize {
        self.world.can_nodes(bus_id(port))
    }

    fn can_broken(&self, port: CanPort) -> bool {
        self.world.can_broken(bus_id(port))
    }

    fn can_present(&self, port: CanPort, node: usize) -> bool {
        self.world.can_present(bus_id(port), node)
    }

    fn can_hears(&self, port: CanPort, node: usize) -> bool {
        self.world.can_hears(bus_id(port), node)
    }

    fn can_pending(&self, port: CanPort, node: usize, now: Ps) -> Option<CanFrame> {
        self.world.can_pending(bus_id(port), node, now)
    }

    fn can_sent(&mut self, port: CanPort, node: usize, now: Ps) {
        self.world.can_sent(bus_id(port), node, now);
    }

    fn can_received(&mut self, port: CanPort, node: usize, frame: &CanFrame, now: Ps) {
        self.world.can_received(bus_id(port), node, frame, now);
    }
}

#[cfg(test)]
mod tests;
