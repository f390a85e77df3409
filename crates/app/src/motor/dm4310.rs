//! Damiao DM4310 (docs/hardware.md#dm4310): standard identifiers, one reply to each frame.

use super::{
    mit::{MitCommand, MitRanges, MitReport},
    setpoint::{self, finite_within, two_floats},
};
use crate::domain::{CanFrame, StandardId};

/// Identifier of register reads and writes for all motors. The payload addresses one of them.
pub const REGISTER_ID: StandardId = match StandardId::new(0x7FF) {
    Some(id) => id,
    None => unreachable!(),
};

const READ: u8 = 0x33;
const WRITE: u8 = 0x55;

/// One motor: its identifiers, and the ranges that scale its codes.
///
/// ```
/// use robot_app::motor::{dm4310::Dm4310, mit::{MitCommand, MitRanges, MitTargets}};
///
/// let ranges = MitRanges { p_max_rad: 12.5, v_max_rps: 30.0, t_max_nm: 10.0 };
/// let motor = Dm4310::new(1, 0x11, ranges).unwrap();
/// let frame = motor.mit(MitCommand::clamped(&MitTargets::default(), motor.ranges()));
/// assert_eq!(frame.id().raw(), 1);
/// assert_eq!(frame.payload(), [0x7F, 0xFF, 0x7F, 0xF0, 0x00, 0x00, 0x07, 0xFF]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dm4310 {
    mit_id: StandardId,
    position_speed_id: StandardId,
    speed_id: StandardId,
    master_id: StandardId,
    number: u8,
    ranges: MitRanges,
}

/// A register of the motor. Each value has four bytes, little-endian.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Register {
    /// Time without frames after which an enabled motor releases torque. A u32 in steps of 50 µs; 0 = never.
    Timeout = 9,
    /// A u32: see [`ControlMode`].
    ControlMode = 10,
    /// Full scale of positions, f32 in rad.
    PositionRange = 0x15,
    /// Full scale of speeds, f32 in rad/s.
    VelocityRange = 0x16,
    /// Full scale of torques, f32 in N·m.
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
    /// Position, speed, gains and torque in one frame.
    Mit = 1,
    /// Target position with a speed limit.
    PositionSpeed = 2,
    /// Target speed.
    Speed = 3,
}

/// Motor state, from the upper half of byte 0 of a reply.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Status {
    /// The motor gives no torque.
    Disabled = 0,
    /// The motor follows commands.
    Enabled = 1,
    /// Supply voltage too high.
    OverVoltage = 8,
    /// Supply voltage too low.
    UnderVoltage = 9,
    /// Current too high.
    OverCurrent = 0xA,
    /// Driver temperature too high.
    DriverTooHot = 0xB,
    /// Winding temperature too high.
    WindingTooHot = 0xC,
    /// No frame came within the time-out.
    CommunicationLost = 0xD,
    /// Overload.
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

    /// The fault's code, or 0 for a motor without fault.
    pub fn fault_code(self) -> u32 {
        match self {
            Self::Disabled | Self::Enabled => 0,
            fault => u32::from(fault as u8),
        }
    }
}

/// A reply to a command, in motor coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Feedback {
    /// State of the motor.
    pub status: Status,
    /// Position, speed and torque.
    pub motion: MitReport,
    /// Temperature of the driver in °C.
    pub driver_c: u8,
    /// Temperature of the winding in °C.
    pub winding_c: u8,
}

impl Dm4310 {
    /// Returns `None` unless `number` (ESC_ID) is 1…15, `master_id` (MST_ID) has eleven bits and the ranges are
    /// positive.
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

    /// Full scale of the motor's codes.
    pub const fn ranges(&self) -> &MitRanges {
        &self.ranges
    }

    /// Identifiers of its three kinds of command frames, followed by that of its replies.
    pub const fn identifiers(&self) -> [StandardId; 4] {
        [
            self.mit_id,
            self.position_speed_id,
            self.speed_id,
            self.master_id,
        ]
    }

    /// Enables the motor.
    pub const fn enable(&self) -> CanFrame {
        self.service_frame(0xFC)
    }

    /// Disables the motor: its torque is exactly zero until it is enabled.
    pub const fn disable(&self) -> CanFrame {
        self.service_frame(0xFD)
    }

    /// Makes the present angle the motor's zero.
    pub const fn set_zero(&self) -> CanFrame {
        self.service_frame(0xFE)
    }

    /// Clears a fault.
    pub const fn clear_fault(&self) -> CanFrame {
        self.service_frame(0xFB)
    }

    const fn service_frame(&self, code: u8) -> CanFrame {
        CanFrame::new(
            self.mit_id,
            [0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, code],
        )
    }

    /// Commands MIT mode.
    pub fn mit(&self, command: MitCommand) -> CanFrame {
        CanFrame::new(self.mit_id, command.payload())
    }

    /// Commands position mode. The angle is clamped to the motor's range and the speed limit to 0…`v_max_rps`. If the
    /// angle is NaN, the speed limit becomes 0.
    pub fn position_speed(&self, pos_rad: f32, max_speed_rps: f32) -> CanFrame {
        let payload = setpoint::position_speed(pos_rad, max_speed_rps, &self.ranges);
        CanFrame::new(self.position_speed_id, payload)
    }

    /// Commands speed mode. The speed is clamped to the motor's range; NaN becomes 0.
    pub fn speed(&self, vel_rps: f32) -> CanFrame {
        let vel_rps = finite_within(vel_rps, self.ranges.v_max_rps);
        CanFrame::new(self.speed_id, two_floats(vel_rps, 0.0))
    }

    /// Requests a register's value.
    pub const fn read_register(&self, register: Register) -> CanFrame {
        let payload = [self.number, 0, READ, register as u8, 0, 0, 0, 0];
        CanFrame::new(REGISTER_ID, payload)
    }

    /// Writes a register until power-off. The motor may be silent for 150 ms afterwards.
    pub const fn write_register(&self, register: Register, value: u32) -> CanFrame {
        let [a, b, c, d] = value.to_le_bytes();
        CanFrame::new(
            REGISTER_ID,
            [self.number, 0, WRITE, register as u8, a, b, c, d],
        )
    }

    /// Decodes a complete reply of this motor. Returns `None` for an undocumented status and for a late answer to a
    /// register request, which would look like a motor at the end of its range.
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

    /// Whether the frame looks like the answer to a register request. An ordinary reply looks the same only 0.02 to
    /// 0.03 rad from the lower end of the range at −24 rad/s or faster (of ±12.5 rad and ±30 rad/s).
    fn is_register_answer(&self, frame: &CanFrame) -> bool {
        let [number, 0, READ | WRITE, index, ..] = frame.padded_payload() else {
            return false;
        };
        number == self.number
            && Register::ALL
                .iter()
                .any(|&register| register as u8 == index)
    }

    /// Decodes the answer to a read or write of `register`. It differs from other replies only in its content, so
    /// call this only while such an answer is due.
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
