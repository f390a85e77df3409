//! One interface to the protocols of DM4310 and RS00.

use super::super::{
    dm4310::{self, Register},
    layout::JointMotor,
    mit::{MitCommand, MitReport, MitTargets},
    rs00,
};
use crate::domain::{CanFrame, JointMode};

/// State of a motor as far as its replies show it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    Disabled,
    Enabled,
    /// An RS00 without fault. Its replies do not show whether it is enabled.
    Working,
    /// A fault in the motor's own coding; 0 if the motor does not name it.
    Fault(u32),
}

/// An ordinary reply, in motor coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Report {
    pub motion: MitReport,
    /// The higher of driver and winding temperature in °C, as far as the motor reports them.
    pub temperature_c: f32,
    pub status: Status,
}

/// What the next reply may carry besides a report. Replies differ only in their content.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Expected {
    Report,
    Register(Register),
    FaultWord,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reply {
    Report(Report),
    Register(u32),
    FaultWord(rs00::Faults),
}

impl JointMotor {
    /// Disables the motor.
    pub const fn disable(&self) -> CanFrame {
        match self {
            Self::Dm4310(motor) => motor.disable(),
            Self::Rs00(motor) => motor.disable(),
        }
    }

    /// Enables the motor.
    pub fn enable(&self) -> CanFrame {
        match self {
            Self::Dm4310(motor) => motor.enable(),
            Self::Rs00(motor) => motor.enable(),
        }
    }

    /// Clears a fault.
    pub fn clear_fault(&self) -> CanFrame {
        match self {
            Self::Dm4310(motor) => motor.clear_fault(),
            Self::Rs00(motor) => motor.clear_fault(),
        }
    }

    /// Requests the fault word. `None` for a motor whose ordinary replies show every fault.
    pub fn read_faults(&self) -> Option<CanFrame> {
        match self {
            Self::Dm4310(_) => None,
            Self::Rs00(motor) => Some(motor.read_faults()),
        }
    }

    /// Encodes a command. `Off` is an MIT frame without gains and with the torque code nearest to zero, whatever the
    /// targets are.
    pub fn command(&self, mode: JointMode, targets: &MitTargets, max_torque_nm: f32) -> CanFrame {
        match mode {
            JointMode::Off => self.mit(&MitTargets::default()),
            JointMode::Mit => self.mit(targets),
            JointMode::PositionSpeed => self.position_speed(targets),
            JointMode::Speed => self.speed(targets, max_torque_nm),
        }
    }

    fn mit(&self, targets: &MitTargets) -> CanFrame {
        match self {
            Self::Dm4310(motor) => motor.mit(MitCommand::clamped(targets, motor.ranges())),
            Self::Rs00(motor) => motor.mit(MitCommand::clamped(targets, &rs00::RANGES)),
        }
    }

    fn position_speed(&self, targets: &MitTargets) -> CanFrame {
        let max_speed_rps = targets.vel_rps.abs();
        match self {
            Self::Dm4310(motor) => motor.position_speed(targets.pos_rad, max_speed_rps),
            Self::Rs00(motor) => motor.position_speed(targets.pos_rad, max_speed_rps),
        }
    }

    fn speed(&self, targets: &MitTargets, max_torque_nm: f32) -> CanFrame {
        match self {
            Self::Dm4310(motor) => motor.speed(targets.vel_rps),
            Self::Rs00(motor) => motor.speed(targets.vel_rps, max_torque_nm),
        }
    }

    /// Decodes a reply of this motor.
    pub fn decode(&self, frame: &CanFrame, expected: Expected) -> Option<Reply> {
        match (self, expected) {
            (Self::Dm4310(motor), Expected::Register(register)) => motor
                .decode_register(frame, register)
                .map(Reply::Register)
                .or_else(|| motor.decode(frame).map(Reply::from)),
            (Self::Dm4310(motor), _) => motor.decode(frame).map(Reply::from),
            (Self::Rs00(motor), Expected::FaultWord) => motor
                .decode_faults(frame)
                .map(Reply::FaultWord)
                .or_else(|| motor.decode(frame).map(Reply::from)),
            (Self::Rs00(motor), _) => motor.decode(frame).map(Reply::from),
        }
    }
}

impl From<dm4310::Feedback> for Reply {
    fn from(feedback: dm4310::Feedback) -> Self {
        Self::Report(Report {
            motion: feedback.motion,
            temperature_c: f32::from(feedback.driver_c.max(feedback.winding_c)),
            status: match feedback.status {
                dm4310::Status::Disabled => Status::Disabled,
                dm4310::Status::Enabled => Status::Enabled,
                fault => Status::Fault(fault.fault_code()),
            },
        })
    }
}

impl From<rs00::Feedback> for Reply {
    fn from(feedback: rs00::Feedback) -> Self {
        Self::Report(Report {
            motion: feedback.motion,
            temperature_c: feedback.temperature_c,
            status: if feedback.faulty {
                Status::Fault(0)
            } else {
                Status::Working
            },
        })
    }
}
