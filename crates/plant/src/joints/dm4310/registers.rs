//! The DM4310's registers, as far as a robot needs them
//! (docs/hardware.md#dm4310-ranges, docs/hardware.md#dm4310-behaviour).

use super::super::mit_frame::Ranges;

mod rid {
    pub const OVER_TEMPERATURE: u8 = 2;
    pub const MST_ID: u8 = 7;
    pub const ESC_ID: u8 = 8;
    pub const TIMEOUT: u8 = 9;
    pub const CTRL_MODE: u8 = 10;
    pub const PMAX: u8 = 0x15;
    pub const VMAX: u8 = 0x16;
    pub const TMAX: u8 = 0x17;
    pub const CAN_BAUD: u8 = 35;
}

/// Code of the bit rate 1 Mbit/s.
const CAN_BAUD_1M: u32 = 4;
/// Assumed setting: the maker lets users choose.
const OVER_TEMPERATURE_C: f32 = 140.0;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ControlMode {
    Mit = 1,
    PositionSpeed = 2,
    Speed = 3,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Registers {
    pub over_temperature_c: f32,
    pub mst_id: u32,
    pub esc_id: u32,
    /// CAN time-out in units of 50 µs; 0 = off.
    pub timeout: u32,
    pub control_mode: ControlMode,
    pmax_rad: f32,
    vmax_rps: f32,
    tmax_nm: f32,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct NotModelled;

impl Registers {
    /// Factory settings except for the identifiers, which every robot sets.
    pub(super) fn new(esc_id: u32, mst_id: u32) -> Self {
        Self {
            over_temperature_c: OVER_TEMPERATURE_C,
            mst_id,
            esc_id,
            timeout: 0,
            control_mode: ControlMode::Mit,
            pmax_rad: 12.5,
            vmax_rps: 30.0,
            tmax_nm: 10.0,
        }
    }

    pub(super) fn ranges(&self) -> Ranges {
        Ranges {
            pos_rad: self.pmax_rad.into(),
            vel_rps: self.vmax_rps.into(),
            torque_nm: self.tmax_nm.into(),
        }
    }

    pub(super) fn read(&self, register: u8) -> Result<[u8; 4], NotModelled> {
        Ok(match register {
            rid::OVER_TEMPERATURE => self.over_temperature_c.to_le_bytes(),
            rid::MST_ID => self.mst_id.to_le_bytes(),
            rid::ESC_ID => self.esc_id.to_le_bytes(),
            rid::TIMEOUT => self.timeout.to_le_bytes(),
            rid::CTRL_MODE => (self.control_mode as u32).to_le_bytes(),
            rid::PMAX => self.pmax_rad.to_le_bytes(),
            rid::VMAX => self.vmax_rps.to_le_bytes(),
            rid::TMAX => self.tmax_nm.to_le_bytes(),
            rid::CAN_BAUD => CAN_BAUD_1M.to_le_bytes(),
            _ => return Err(NotModelled),
        })
    }

    /// Writes a register. A value out of its range changes nothing.
    pub(super) fn write(&mut self, register: u8, value: [u8; 4]) -> Result<(), NotModelled> {
        let whole = u32::from_le_bytes(value);
        let real = f32::from_le_bytes(value);
        let positive = real.is_finite() && real > 0.0;
        match register {
            rid::OVER_TEMPERATURE if positive => self.over_temperature_c = real,
            rid::MST_ID if whole <= 0x7FF => self.mst_id = whole,
            rid::ESC_ID if whole <= 0x7FF => self.esc_id = whole,
            rid::TIMEOUT => self.timeout = whole,
            rid::CTRL_MODE => match whole {
                1 => self.control_mode = ControlMode::Mit,
                2 => self.control_mode = ControlMode::PositionSpeed,
                3 => self.control_mode = ControlMode::Speed,
                // Force-position control.
                4 => return Err(NotModelled),
                _ => {}
            },
            rid::PMAX if positive => self.pmax_rad = real,
            rid::VMAX if positive => self.vmax_rps = real,
            rid::TMAX if positive => self.tmax_nm = real,
            _ => {
                self.read(register)?;
            }
        }
        Ok(())
    }
}
