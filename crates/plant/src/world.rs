//! The whole world as the board sees it: one object, advanced in time, with one method a wire.

use crate::{
    time::Ps,
    wire::{CanFrame, UartChar},
};

/// Which robot stands around the board.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlantKind {
    /// Body fixed, wheels in the air.
    Stand,
    /// Upright body rolling on flat ground.
    Rolling,
}

/// Which radio is plugged into the DBUS connector.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RadioKind {
    Sbus,
    Dbus,
}

#[derive(Clone, Debug)]
pub struct WorldConfig {
    pub plant: PlantKind,
    pub radio: RadioKind,
    pub seed: u64,
    /// A recorded trial (`<trial>.json` beside its `.f32.gz`) played through the IMU and magnetometer models.
    pub imu_trial: Option<std::path::PathBuf>,
}

#[derive(Debug, thiserror::Error)]
pub enum WorldError {
    #[error("no fault is named `{0}`; `cargo xtask sim --list-faults` lists them")]
    UnknownFault(String),
    #[error("cannot read the recorded trial {path}: {why}")]
    Trial { path: std::path::PathBuf, why: String },
}

/// Sticks and switches of the pilot; an unset field keeps its value.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RemoteInput {
    pub enable: Option<bool>,
    pub e_stop: Option<bool>,
    /// −1 … 1, forward positive.
    pub vx: Option<f64>,
    /// −1 … 1, left turn (counter-clockwise from above) positive.
    pub wz: Option<f64>,
    /// Three-position switch: 0, 1, 2.
    pub mode: Option<u8>,
}

#[derive(Clone, Copy, Debug)]
pub struct FaultInfo {
    pub name: &'static str,
    pub what: &'static str,
}

/// A value that changed on a wire, at the instant it changed.
#[derive(Clone, Copy, Debug)]
pub struct WireEvent {
    pub at: Ps,
    /// Index into `World::signal_names`.
    pub signal: usize,
    pub value: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpiSelect {
    Accel,
    Gyro,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CanBusId {
    Can1,
    Can2,
}

pub struct World {
    config: WorldConfig,
}

impl World {
    pub fn new(config: WorldConfig) -> Result<Self, WorldError> {
        Ok(Self { config })
    }

    /// The next instant at which something happens here by itself (physics step, radio character, motor feedback).
    pub fn next_event(&self) -> Ps {
        let _ = &self.config;
        Ps::MAX
    }

    /// Brings the world up to `now`; never called with an earlier time than before.
    pub fn advance(&mut self, _now: Ps) {}

    pub fn set_remote(&mut self, _input: RemoteInput) {}

    pub fn set_fault(&mut self, name: &str, _active: bool) -> Result<(), WorldError> {
        Err(WorldError::UnknownFault(name.to_owned()))
    }

    pub fn faults() -> &'static [FaultInfo] {
        &[]
    }

    /// Names of every signal: `truth.*` from the plant, `can.*` as decoded from the wire, `radio.*`.
    pub fn signal_names(&self) -> &[String] {
        &[]
    }

    /// Present value of every signal, in the order of `signal_names`.
    pub fn sample(&self, _out: &mut Vec<f64>) {}

    /// Wire-level changes since the last call (every received actuator command is one).
    pub fn drain_wire_events(&mut self, _out: &mut Vec<WireEvent>) {}

    /// Attitude error of `q_wxyz` (body → ENU earth) against truth or the recording's reference, in degrees:
    /// `[total, heading, inclination]`; `None` in a gap of the reference.
    pub fn attitude_error_deg(&self, _q_wxyz: [f64; 4]) -> Option<[f64; 3]> {
        None
    }

    // SPI1: BMI088
    pub fn spi_select(&mut self, _device: SpiSelect, _selected: bool, _now: Ps) {}
    /// Exchanges one byte with the selected device; 0xFF (pulled up) where none is.
    /// `sck_hz` and the SPI mode come from the chip's registers; a device out of its limits answers garbage.
    pub fn spi_transfer(&mut self, _mosi: u8, _sck_hz: u32, _mode: u8, _now: Ps) -> u8 {
        0xFF
    }

    // I2C3: IST8310
    /// START and address byte; true = acknowledged.
    pub fn i2c_address(&mut self, _addr7: u8, _read: bool, _scl_hz: u32, _now: Ps) -> bool {
        false
    }
    pub fn i2c_write(&mut self, _byte: u8, _now: Ps) -> bool {
        false
    }
    pub fn i2c_read(&mut self, _ack: bool, _now: Ps) -> u8 {
        0xFF
    }
    pub fn i2c_stop(&mut self, _now: Ps) {}
    /// True where a device holds SDA or SCL low.
    pub fn i2c_bus_held(&self) -> bool {
        false
    }

    // Plain pins
    /// IST8310 RSTN (PG6): level seen by the chip.
    pub fn set_mag_reset_pin(&mut self, _high: bool, _now: Ps) {}
    /// IST8310 DRDY (PG3).
    pub fn mag_drdy_pin(&self) -> bool {
        true
    }
    /// Mean on-fraction of the heater FET (PF6), 0 … 1.
    pub fn set_heater_duty(&mut self, _duty: f64, _now: Ps) {}
    /// LED brightness, blue, green, red, 0 … 1.
    pub fn set_leds(&mut self, _bgr: [f64; 3], _now: Ps) {}
    /// Buzzer drive: frequency and duty; duty 0 = silent.
    pub fn set_buzzer(&mut self, _hz: f64, _duty: f64, _now: Ps) {}
    /// Volts at PF10 (battery behind the 200 k / 22 k divider).
    pub fn battery_adc_volts(&self) -> f64 {
        24.0 * 22.0 / 222.0
    }
    /// PA0, active low.
    pub fn user_key_pin(&self) -> bool {
        true
    }

    // UART
    /// The next character on the USART3 RX line (radio) whose start bit falls at or before `now`.
    pub fn radio_char(&mut self, _now: Ps) -> Option<UartChar> {
        None
    }

    // CAN. The bus model asks every node at each start of frame; nodes are numbered from 0 on each bus.
    pub fn can_nodes(&self, _bus: CanBusId) -> usize {
        0
    }
    /// A node that is unpowered or unplugged neither sends nor acknowledges.
    pub fn can_present(&self, _bus: CanBusId, _node: usize) -> bool {
        false
    }
    /// The frame this node wants on the bus now.
    pub fn can_pending(&self, _bus: CanBusId, _node: usize, _now: Ps) -> Option<CanFrame> {
        None
    }
    /// Its pending frame went out and was acknowledged.
    pub fn can_sent(&mut self, _bus: CanBusId, _node: usize, _now: Ps) {}
    /// A frame of another node ended without error (called once for each present node but the sender).
    pub fn can_received(&mut self, _bus: CanBusId, _node: usize, _frame: &CanFrame, _now: Ps) {}
    /// True while a fault cuts or shorts this bus for everybody.
    pub fn can_broken(&self, _bus: CanBusId) -> bool {
        false
    }
}
