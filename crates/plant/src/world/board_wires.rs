//! Every wire of the board except CAN.

use super::{WireEvent, World, signals};
use crate::{
    complaint::Complaint,
    faults::Fault,
    serial_adapter::{LINK_FORMAT, SerialAdapter},
    time::Ps,
    wire::{LineEvent, SpiSelect, UartChar},
};

/// How much warmer the chip is than the board around it: some 70 mA at 3.3 V, and 39 K/W of the package (DS8626, thermal
/// characteristics of the UFBGA176). The current is assumed.
const CHIP_ABOVE_BOARD_K: f64 = 9.0;

/// SPI1: BMI088.
impl World {
    /// Sets a chip select; `selected` means low.
    pub fn spi_select(&mut self, device: SpiSelect, selected: bool, now: Ps) {
        self.advance(now);
        self.imu.select(device, selected, now);
    }

    /// Exchanges one byte with the selected device, or reads 0xFF (pulled up) if none is selected.
    ///
    /// `sck_hz` and the SPI mode come from the chip's registers. A device outside of its limits answers garbage and
    /// complains.
    pub fn spi_transfer(&mut self, mosi: u8, sck_hz: u32, mode: u8, now: Ps) -> u8 {
        self.advance(now);
        self.complaints.extend(self.imu.misuse(sck_hz, mode));
        let miso = self.imu.transfer(mosi, sck_hz, mode, now);
        self.complaints.extend(self.imu.take_complaints());
        miso
    }
}

/// I2C3: IST8310.
impl World {
    /// START and address byte; true if acknowledged. Too fast a clock is not acknowledged, and the device complains.
    pub fn i2c_address(&mut self, addr7: u8, read: bool, scl_hz: u32, now: Ps) -> bool {
        self.advance(now);
        self.complaints.extend(self.mag.misuse(addr7, scl_hz));
        self.mag.address(addr7, read, scl_hz, now)
    }

    /// Data byte to the device; true if acknowledged.
    pub fn i2c_write(&mut self, byte: u8, now: Ps) -> bool {
        self.advance(now);
        self.mag.write(byte, now)
    }

    /// Data byte from the device. A refused acknowledge ends nothing: the STOP that follows does.
    pub fn i2c_read(&mut self, _ack: bool, now: Ps) -> u8 {
        self.advance(now);
        self.mag.read(now)
    }

    /// STOP: ends the transfer.
    pub fn i2c_stop(&mut self, now: Ps) {
        self.advance(now);
        self.mag.stop();
    }

    /// True while a device holds SDA or SCL low.
    pub fn i2c_bus_held(&self) -> bool {
        self.mag.bus_held()
    }
}

impl World {
    /// Takes the complaints since the last call: devices that the board used outside of their limits. On a real board nothing
    /// reports this.
    pub fn take_complaints(&mut self) -> Vec<Complaint> {
        std::mem::take(&mut self.complaints)
    }
}

/// Plain pins.
impl World {
    /// Sets the level of RSTN of the IST8310 (PG6).
    pub fn set_mag_reset_pin(&mut self, high: bool, now: Ps) {
        self.advance(now);
        self.mag.set_reset_pin(high, now);
    }

    /// Level of DRDY of the IST8310 (PG3).
    pub fn mag_drdy_pin(&self) -> bool {
        self.mag.drdy_pin()
    }

    /// Sets the duty cycle of the heater (PF6), 0 … 1.
    pub fn set_heater_duty(&mut self, duty: f64, now: Ps) {
        self.advance(now);
        self.imu.set_heater_duty(duty);
    }

    /// Sets the brightness of the LED: blue, green, red, 0 … 1.
    pub fn set_leds(&mut self, bgr: [f64; 3], now: Ps) {
        self.advance(now);
        self.indicators.leds_bgr = bgr;
    }

    /// Drives the buzzer with a frequency and a duty cycle; at a duty of 0 it is silent.
    pub fn set_buzzer(&mut self, hz: f64, duty: f64, now: Ps) {
        self.advance(now);
        self.indicators.buzzer_hz = if duty > 0.0 { hz } else { 0.0 };
    }

    /// Voltage at PF10, V: the battery behind the divider of 200 kΩ and 22 kΩ.
    pub fn battery_adc_volts(&self) -> f64 {
        self.battery.adc_volts()
    }

    /// Supply and reference voltage of the chip's converters, V.
    pub fn vdda_v(&self) -> f64 {
        if self.faults.has(Fault::VddaHigh) {
            3.4
        } else if self.faults.has(Fault::VddaLow) {
            3.2
        } else {
            3.3
        }
    }

    /// Temperature of the chip's die, °C.
    pub fn chip_temperature_c(&self) -> f64 {
        self.imu.board_c() + CHIP_ABOVE_BOARD_K
    }

    /// Level of the user key (PA0), active low: nobody presses it.
    pub fn user_key_pin(&self) -> bool {
        true
    }
}

/// USART3: radio.
impl World {
    /// Takes the next character on the line of the radio receiver (USART3 RX) whose start bit begins at or before `now`.
    pub fn radio_char(&mut self, now: Ps) -> Option<UartChar> {
        self.advance(now);
        self.radio.take(now)
    }
}

/// USART1: the PC.
impl World {
    /// The serial adapter of the PC at the 4-pin UART2.
    pub fn serial_adapter(&mut self) -> &mut SerialAdapter {
        &mut self.serial_adapter
    }

    /// Level that the PC's adapter drives onto USART1 RX (PB7) while it sends nothing; `None` while no cable is plugged in.
    pub fn link_rx_pin(&self) -> Option<bool> {
        let plugged = self.serial_adapter.plugged() || self.pc.plugged();
        (plugged && !self.link_faults().cut_down).then_some(true)
    }

    /// What happens next on the line into USART1 RX (PB7), if it begins at or before `now`.
    pub fn link_event(&mut self, now: Ps) -> Option<LineEvent> {
        self.advance(now);
        let faults = self.link_faults();
        while let Some(character) = self.serial_adapter.next_character(now) {
            self.pc.pass(character, faults);
        }
        self.pc.next_on_the_line(now)
    }

    /// Notes the frames of the PC that are whole at the board.
    pub(super) fn note_whole_frames(&mut self) {
        while let Some(at) = self.pc.next_whole(self.now) {
            self.wire_events.push(WireEvent {
                at,
                signal: signals::LINK_DOWN_FRAMES,
                value: self.pc.down_frames as f64,
            });
        }
    }

    /// The board sent a character on USART1 TX (PA9), whose last stop bit ends `now`. A character that no PC can read is
    /// complained of even while none is plugged in.
    pub fn link_sent(&mut self, character: UartChar, now: Ps) {
        self.advance(now);
        if !LINK_FORMAT.understands(character.format) {
            self.complaints.push(Complaint::fails(format!(
                "USART1 sends {}, the PC listens at {LINK_FORMAT}: it hears garbage",
                character.format
            )));
        }
        let Some(heard) = self.pc.arrives(character, self.link_faults()) else {
            return;
        };
        self.serial_adapter.receive(heard, now);
        if self.pc.receive(heard, now) {
            self.wire_events.push(WireEvent {
                at: now,
                signal: signals::LINK_UP_FRAMES,
                value: self.pc.meter.frames() as f64,
            });
        }
    }
}
