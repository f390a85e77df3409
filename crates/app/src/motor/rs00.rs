//! RobStride RS00 in its MIT protocol (docs/hardware.md#rs00): standard identifiers, one reply to each frame. Replies
//! have the host's identifier, and the motor's number in byte 0.

use super::{
    mit::{MitCommand, MitRanges, MitReport},
    setpoint::{self, finite_within, two_floats},
};
use crate::domain::{CanFrame, StandardId};

/// Full scale of the codes (RS00 manual; firmware 0.0.2.6 and newer).
pub const RANGES: MitRanges = MitRanges {
    p_max_rad: 12.57,
    v_max_rps: 33.0,
    t_max_nm: 14.0,
};

/// One motor and the host identifier of its replies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rs00 {
    mit_id: StandardId,
    position_id: StandardId,
    speed_id: StandardId,
    host_id: StandardId,
    number: u8,
}

/// Control mode. A motor must be stopped while it changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum RunMode {
    /// Position, speed, gains and torque in one frame.
    Mit = 0,
    /// Target position with a speed limit.
    Position = 1,
    /// Target speed with a current limit.
    Speed = 2,
}

/// The motor's fault bits (RS00 MIT reference, section 4.5), where the motor puts them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Faults(u32);

impl Faults {
    /// Temperature above 145 °C.
    pub const OVER_TEMPERATURE: Self = Self(1 << 0);
    /// Fault of the driver chip.
    pub const DRIVER_CHIP: Self = Self(1 << 1);
    /// Supply voltage below 12 V.
    pub const UNDER_VOLTAGE: Self = Self(1 << 2);
    /// Supply voltage above 60 V.
    pub const OVER_VOLTAGE: Self = Self(1 << 3);
    /// Overcurrent in phase B.
    pub const PHASE_B_CURRENT: Self = Self(1 << 4);
    /// Overcurrent in phase C.
    pub const PHASE_C_CURRENT: Self = Self(1 << 5);
    /// The encoder is not calibrated.
    pub const ENCODER_NOT_CALIBRATED: Self = Self(1 << 7);
    /// The hardware was not identified.
    pub const HARDWARE_IDENTIFICATION: Self = Self(1 << 8);
    /// The initial position was not found.
    pub const POSITION_INITIALISATION: Self = Self(1 << 9);
    /// Overload at stall.
    pub const STALL_OVERLOAD: Self = Self(1 << 14);
    /// Overcurrent in phase A.
    pub const PHASE_A_CURRENT: Self = Self(1 << 16);

    const ALL: u32 = Self::OVER_TEMPERATURE.0
        | Self::DRIVER_CHIP.0
        | Self::UNDER_VOLTAGE.0
        | Self::OVER_VOLTAGE.0
        | Self::PHASE_B_CURRENT.0
        | Self::PHASE_C_CURRENT.0
        | Self::ENCODER_NOT_CALIBRATED.0
        | Self::HARDWARE_IDENTIFICATION.0
        | Self::POSITION_INITIALISATION.0
        | Self::STALL_OVERLOAD.0
        | Self::PHASE_A_CURRENT.0;

    /// The fault word.
    pub const fn bits(self) -> u32 {
        self.0
    }
}

/// A reply to a command, in motor coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Feedback {
    /// Position, speed and torque.
    pub motion: MitReport,
    /// Temperature in °C.
    pub temperature_c: f32,
    /// The motor has a fault: bit 5 of byte 6, in firmware that uses this byte for faults. In other firmware the bit
    /// belongs to a temperature that no motor survives.
    pub faulty: bool,
}

const FAULT_BIT: u8 = 1 << 5;

/// Torque constant in N·m/A (RS00 manual, effective value).
const TORQUE_CONSTANT: f32 = 1.48;

impl Rs00 {
    /// Returns `None` unless `number` is 1…127.
    pub const fn new(number: u8, host: u8) -> Option<Self> {
        if number == 0 || number > 127 {
            return None;
        }
        let number_id = number as u16;
        match (
            StandardId::new(number_id),
            StandardId::new(0x100 | number_id),
            StandardId::new(0x200 | number_id),
            StandardId::new(host as u16),
        ) {
            (Some(mit_id), Some(position_id), Some(speed_id), Some(host_id)) => Some(Self {
                mit_id,
                position_id,
                speed_id,
                host_id,
                number,
            }),
            _ => None,
        }
    }

    /// Identifiers of its three kinds of command frames, followed by that of its replies.
    pub const fn identifiers(&self) -> [StandardId; 4] {
        [self.mit_id, self.position_id, self.speed_id, self.host_id]
    }

    /// Enables the motor.
    pub const fn enable(&self) -> CanFrame {
        self.service_frame(0xFF, 0xFC)
    }

    /// Stops the motor: its torque is exactly zero until it is enabled.
    pub const fn disable(&self) -> CanFrame {
        self.service_frame(0xFF, 0xFD)
    }

    /// Makes the present angle the motor's zero. The motor refuses this in position mode.
    pub const fn set_zero(&self) -> CanFrame {
        self.service_frame(0xFF, 0xFE)
    }

    /// Clears a fault.
    pub const fn clear_fault(&self) -> CanFrame {
        self.service_frame(0xFF, 0xFB)
    }

    /// Requests the fault word. One of the next replies of this motor carries it (see
    /// [`decode_faults`](Self::decode_faults)).
    pub const fn read_faults(&self) -> CanFrame {
        self.service_frame(0x00, 0xFB)
    }

    /// Sets the control mode.
    pub const fn set_mode(&self, mode: RunMode) -> CanFrame {
        self.service_frame(mode as u8, 0xFC)
    }

    const fn service_frame(&self, detail: u8, code: u8) -> CanFrame {
        CanFrame::new(
            self.mit_id,
            [0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, detail, code],
        )
    }

    /// Commands MIT mode.
    pub fn mit(&self, command: MitCommand) -> CanFrame {
        CanFrame::new(self.mit_id, command.payload())
    }

    /// Commands position mode. The angle is clamped to the motor's range and the speed limit to 0…`v_max_rps`. If the
    /// angle is NaN, the speed limit becomes 0.
    pub fn position_speed(&self, pos_rad: f32, max_speed_rps: f32) -> CanFrame {
        let payload = setpoint::position_speed(pos_rad, max_speed_rps, &RANGES);
        CanFrame::new(self.position_id, payload)
    }

    /// Commands speed mode. The speed is clamped to the motor's range; NaN becomes 0. The torque limit is sent as a
    /// current limit.
    pub fn speed(&self, vel_rps: f32, max_torque_nm: f32) -> CanFrame {
        let torque_nm = finite_within(max_torque_nm, RANGES.t_max_nm).max(0.0);
        CanFrame::new(
            self.speed_id,
            two_floats(
                finite_within(vel_rps, RANGES.v_max_rps),
                torque_nm / TORQUE_CONSTANT,
            ),
        )
    }

    /// Decodes a complete reply of this motor.
    pub fn decode(&self, frame: &CanFrame) -> Option<Feedback> {
        let [p_high, p_low, v_high, v_t, t_low, status, temperature] = self.body(frame)?;
        let tenths = u16::from_be_bytes([status, temperature]) & 0x0FFF;
        Some(Feedback {
            motion: MitReport::decode([p_high, p_low, v_high, v_t, t_low], &RANGES),
            temperature_c: f32::from(tenths) / 10.0,
            faulty: status & FAULT_BIT != 0,
        })
    }

    /// Decodes the fault word. Ordinary replies come around it and in its place if it is lost, so a word with unknown
    /// bits is rejected. Only a motor at full speed backwards could pass for one. The byte order is assumed to be
    /// little-endian, as in the motor's other protocol.
    pub fn decode_faults(&self, frame: &CanFrame) -> Option<Faults> {
        let [a, b, c, d, ..] = self.body(frame)?;
        let word = u32::from_le_bytes([a, b, c, d]);
        (word & !Faults::ALL == 0).then_some(Faults(word))
    }

    /// Returns what follows the motor's number, if the frame is from this motor.
    fn body(&self, frame: &CanFrame) -> Option<[u8; 7]> {
        if frame.id() != self.host_id {
            return None;
        }
        let [number, body @ ..] = frame.full_payload()?;
        (number == self.number).then_some(body)
    }
}
