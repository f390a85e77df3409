//! Damiao DM4310 (docs/hardware.md#dm4310): standard identifiers, one reply to each frame.

use super::{
    mit::{MitCommand, MitRanges, MitReport},
    set_point::{self, finite_within, two_floats},
};
use crate::domain::{CanFrame, StandardId};

/// Carries register reads and writes to every motor; the payload says to which.
pub const REGISTER_ID: StandardId = match StandardId::new(0x7FF) {
    Some(id) => id,
    None => unreachable!(),
};

const READ: u8 = 0x33;
const WRITE: u8 = 0x55;

/// One motor: its identifiers and the ranges its codes are scaled with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dm4310 {
    mit_id: StandardId,
    position_speed_id: StandardId,
    speed_id: StandardId,
    master_id: StandardId,
    number: u8,
    ranges: MitRanges,
}

/// Settings a motor keeps. The value of each is four bytes, little-endian.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Register {
    /// u32 in 50 µs: silence after which an enabled motor lets go; 0 = never.
    Timeout = 9,
    /// u32: see [`ControlMode`].
    ControlMode = 10,
    /// f32, rad.
    PositionRange = 0x15,
    /// f32, rad/s.
    VelocityRange = 0x16,
    /// f32, N·m.
    TorqueRange = 0x17,
}

impl Register {
    const ALL: [Self; 5] = [
        Self::Timeout,
        Self::ControlMode,
        Self::PositionRange,
        Self::VelocityRange,
        Self::TorqueRange,
    ];
}

/// Values of [`Register::ControlMode`]. A motor ignores command frames of any other mode.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum ControlMode {
    Mit = 1,
    PositionSpeed = 2,
    Speed = 3,
}

/// The upper half of byte 0 of a reply.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Status {
    Disabled = 0,
    Enabled = 1,
    OverVoltage = 8,
    UnderVoltage = 9,
    OverCurrent = 0xA,
    DriverTooHot = 0xB,
    WindingTooHot = 0xC,
    CommunicationLost = 0xD,
    Overload = 0xE,
}

impl Status {
    fn from_nibble(nibble: u8) -> Option<Self> {
        Some(match nibble {
            0 => Self::Disabled,
            1 => Self::Enabled,
            8 => Self::OverVoltage,
            9 => Self::UnderVoltage,
            0xA => Self::OverCurrent,
            0xB => Self::DriverTooHot,
            0xC => Self::WindingTooHot,
            0xD => Self::CommunicationLost,
            0xE => Self::Overload,
            _ => return None,
        })
    }

    /// 0 unless the motor refuses to work.
    pub fn fault_code(self) -> u32 {
        match self {
            Self::Disabled | Self::Enabled => 0,
            fault => u32::from(fault as u8),
        }
    }
}

/// The reply to a command, motor coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Feedback {
    pub status: Status,
    pub motion: MitReport,
    pub driver_c: u8,
    pub winding_c: u8,
}

impl Dm4310 {
    /// `None` unless `number` (ESC_ID) is 1 … 15, `master_id` (MST_ID) has eleven bits and the ranges are positive.
    pub const fn new(number: u8, master_id: u16, ranges: MitRanges) -> Option<Self> {
        let positive = ranges.p_max_rad > 0.0 && ranges.v_max_rps > 0.0 && ranges.t_max_nm > 0.0;
        if number == 0 || number > 15 || !positive {
            return None;
        }
        let number_id = number as u16;
        match (
            StandardId::new(number_id),
            StandardId::new(0x100 | number_id),
            StandardId::new(0x200 | number_id),
            StandardId::new(master_id),
        ) {
            (Some(mit_id), Some(position_speed_id), Some(speed_id), Some(master_id)) => {
                Some(Self {
                    mit_id,
                    position_speed_id,
                    speed_id,
                    master_id,
                    number,
                    ranges,
                })
            }
            _ => None,
        }
    }

    pub const fn ranges(&self) -> &MitRanges {
        &self.ranges
    }

    /// Those of its three kinds of command frames, then that of its replies.
    pub const fn identifiers(&self) -> [StandardId; 4] {
        [
            self.mit_id,
            self.position_speed_id,
            self.speed_id,
            self.master_id,
        ]
    }

    pub const fn enable(&self) -> CanFrame {
        self.order(0xFC)
    }

    /// Torque exactly zero from here on.
    pub const fn disable(&self) -> CanFrame {
        self.order(0xFD)
    }

    /// Makes the present angle the motor's zero.
    pub const fn set_zero(&self) -> CanFrame {
        self.order(0xFE)
    }

    pub const fn clear_fault(&self) -> CanFrame {
        self.order(0xFB)
    }

    const fn order(&self, code: u8) -> CanFrame {
        CanFrame::new(
            self.mit_id,
            [0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, code],
        )
    }

    pub fn mit(&self, command: MitCommand) -> CanFrame {
        CanFrame::new(self.mit_id, command.payload())
    }

    /// Both are clamped to the motor's ranges, the speed from below at 0; an angle that is no number does not move it.
    pub fn position_speed(&self, pos_rad: f32, max_speed_rps: f32) -> CanFrame {
        let payload = set_point::position_speed(pos_rad, max_speed_rps, &self.ranges);
        CanFrame::new(self.position_speed_id, payload)
    }

    /// Clamped to the motor's range, NaN becomes 0.
    pub fn speed(&self, vel_rps: f32) -> CanFrame {
        let vel_rps = finite_within(vel_rps, self.ranges.v_max_rps);
        CanFrame::new(self.speed_id, two_floats(vel_rps, 0.0))
    }

    pub const fn read_register(&self, register: Register) -> CanFrame {
        let payload = [self.number, 0, READ, register as u8, 0, 0, 0, 0];
        CanFrame::new(REGISTER_ID, payload)
    }

    /// Lasts until power-off; the motor may be silent for 150 ms afterwards.
    pub const fn write_register(&self, register: Register, value: u32) -> CanFrame {
        let [a, b, c, d] = value.to_le_bytes();
        CanFrame::new(
            REGISTER_ID,
            [self.number, 0, WRITE, register as u8, a, b, c, d],
        )
    }

    /// `None` unless it is a whole reply of this motor with a documented status. A late answer to a register request is
    /// none: read as a reply, it is a motor at the end of its range.
    pub fn decode(&self, frame: &CanFrame) -> Option<Feedback> {
        if frame.id() != self.master_id || self.is_register_answer(frame) {
            return None;
        }
        let [head, p_high, p_low, v_high, v_t, t_low, driver_c, winding_c] =
            frame.full_payload()?;
        if head & 0x0F != self.number {
            return None;
        }
        Some(Feedback {
            status: Status::from_nibble(head >> 4)?,
            motion: MitReport::decode([p_high, p_low, v_high, v_t, t_low], &self.ranges),
            driver_c,
            winding_c,
        })
    }

    /// An ordinary reply looks like this only 0.02 or 0.03 rad from the lower end of the range, at 24 rad/s backwards or
    /// more (of ±12.5 rad and ±30 rad/s).
    fn is_register_answer(&self, frame: &CanFrame) -> bool {
        let [number, 0, READ | WRITE, index, ..] = frame.padded_payload() else {
            return false;
        };
        number == self.number
            && Register::ALL
                .iter()
                .any(|&register| register as u8 == index)
    }

    /// The value of `register`, if this is the answer to its read or write. It differs from other replies only in
    /// content, so ask only while such an answer is due.
    pub fn decode_register(&self, frame: &CanFrame, register: Register) -> Option<u32> {
        if frame.id() != self.master_id {
            return None;
        }
        let [number, 0, READ | WRITE, index, a, b, c, d] = frame.full_payload()? else {
            return None;
        };
        (number == self.number && index == register as u8).then(|| u32::from_le_bytes([a, b, c, d]))
    }
}
