//! The four leg joints' drives: left front, left rear, right front, right rear.
//!
//! Drives think in their own sense of rotation; a leg's joint angle is `DIRECTION` times the shaft's, since the right
//! side is mirrored.

mod actuator;
mod dm4310;
mod mit_frame;
mod reply;
mod rs00;
mod speed_loop;

use crate::{time::Ps, wire::CanFrame, world::physics_step_s};
use dm4310::Dm4310;
use mit_frame::FedBack;
use reply::ReplyBox;
use rs00::Rs00;

pub(crate) const JOINTS: usize = 4;
/// Joint angle against shaft angle.
const DIRECTION: [f64; JOINTS] = [1.0, 1.0, -1.0, -1.0];

/// Which motor drives every joint.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum JointKind {
    #[default]
    Dm4310,
    Rs00,
}

/// An output shaft in the motor's own sense.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Shaft {
    pub pos_rad: f64,
    pub vel_rps: f64,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct DriveFaults {
    /// No supply: no torque, no reply, no acknowledge; settings not stored are lost.
    pub gone: bool,
    /// Replies repeat the last one; the motor still obeys.
    pub frozen: bool,
    /// Winding at 120 °C.
    pub hot: bool,
    /// Somebody gave the motor another identifier.
    pub wrong_id: bool,
    /// The driver finds a fault and lets go.
    pub tripped: bool,
    /// A register write takes as long as storing does (DM4310).
    pub slow_writes: bool,
}

/// What became of a frame at a motor.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Heard {
    /// Not meant for it.
    Nothing,
    Frame,
    /// Meant for it, but beyond this model.
    NotModelled(String),
}

enum Drive {
    Dm4310(Dm4310),
    Rs00(Rs00),
}

/// What a wire event tells of.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct WireState {
    pub enabled: bool,
    pub asked_nm: f64,
    pub stop_frames: u64,
}

pub(crate) struct Joint {
    drive: Drive,
    direction: f64,
}

/// ESC_ID or motor identifier 1 to 4; DM4310 reply under 0x11 to 0x14, RS00 under host identifiers set to 0xF1 to 0xF4.
pub(crate) fn drives(kind: JointKind, rs00_timeout: Ps) -> [Joint; JOINTS] {
    std::array::from_fn(|joint| {
        let id = joint as u32 + 1;
        Joint {
            drive: match kind {
                JointKind::Dm4310 => Drive::Dm4310(Dm4310::new(id, 0x10 + id)),
                JointKind::Rs00 => Drive::Rs00(Rs00::new(id, 0xF0 + id, rs00_timeout)),
            },
            direction: DIRECTION[joint],
        }
    })
}

impl Joint {
    /// The drive's shaft for a joint at this angle and speed.
    pub(crate) fn shaft(&self, pos_rad: f64, vel_rps: f64) -> Shaft {
        Shaft {
            pos_rad: self.direction * pos_rad,
            vel_rps: self.direction * vel_rps,
        }
    }

    pub(crate) fn set_faults(&mut self, faults: DriveFaults, now: Ps) {
        match &mut self.drive {
            Drive::Dm4310(drive) => drive.set_faults(faults, now),
            Drive::Rs00(drive) => drive.set_faults(faults),
        }
    }

    pub(crate) fn powered(&self) -> bool {
        match &self.drive {
            Drive::Dm4310(drive) => drive.powered(),
            Drive::Rs00(drive) => drive.powered(),
        }
    }

    pub(crate) fn receive(&mut self, frame: &CanFrame, shaft: Shaft, now: Ps) -> Heard {
        match &mut self.drive {
            Drive::Dm4310(drive) => drive.receive(frame, shaft, now),
            Drive::Rs00(drive) => drive.receive(frame, shaft, now),
        }
    }

    pub(crate) fn step(&mut self, shaft: Shaft, supply_v: f64, now: Ps) {
        let dt_s = physics_step_s();
        match &mut self.drive {
            Drive::Dm4310(drive) => drive.step(shaft, supply_v, now, dt_s),
            Drive::Rs00(drive) => drive.step(shaft, supply_v, now, dt_s),
        }
    }

    pub(crate) fn enabled(&self) -> bool {
        match &self.drive {
            Drive::Dm4310(drive) => drive.enabled(),
            Drive::Rs00(drive) => drive.enabled(),
        }
    }

    pub(crate) fn wire_state(&self, shaft: Shaft) -> WireState {
        let (asked_nm, stop_frames) = match &self.drive {
            Drive::Dm4310(drive) => (drive.asked_nm(shaft), drive.stop_frames()),
            Drive::Rs00(drive) => (drive.asked_nm(shaft), drive.stop_frames()),
        };
        WireState {
            enabled: self.enabled(),
            asked_nm,
            stop_frames,
        }
    }

    fn replies(&self) -> &ReplyBox {
        match &self.drive {
            Drive::Dm4310(drive) => drive.replies(),
            Drive::Rs00(drive) => drive.replies(),
        }
    }

    /// When its waiting reply wants the bus.
    pub(crate) fn reply_at(&self) -> Option<Ps> {
        self.replies().ready_at()
    }

    pub(crate) fn pending(&self, now: Ps) -> Option<CanFrame> {
        self.replies().pending(now)
    }

    pub(crate) fn sent(&mut self) {
        match &mut self.drive {
            Drive::Dm4310(drive) => drive.replies_mut().sent(),
            Drive::Rs00(drive) => drive.replies_mut().sent(),
        }
    }

    pub(crate) fn fed_back(&self) -> FedBack {
        self.replies().on_the_wire()
    }

    fn actuator(&self) -> &actuator::Actuator {
        match &self.drive {
            Drive::Dm4310(drive) => drive.actuator(),
            Drive::Rs00(drive) => drive.actuator(),
        }
    }

    /// On the joint, before the gear's friction.
    pub(crate) fn torque_nm(&self) -> f64 {
        self.direction * self.actuator().torque_nm()
    }

    pub(crate) fn friction_nm(&self) -> f64 {
        self.actuator().rating().friction_nm
    }

    pub(crate) fn temperature_c(&self) -> f64 {
        self.actuator().winding_c()
    }
}
