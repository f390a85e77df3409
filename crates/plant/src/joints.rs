//! The four leg joints' drives: left front, left rear, right front, right rear.
//!
//! A drive counts in its own sense of rotation. The joint angle of a leg is `DIRECTION` times the angle of the shaft, since
//! the right side is mirrored.

mod actuator;
mod dm4310;
mod drive;
mod mit_frame;
mod reply;
mod rs00;
mod speed_loop;

use crate::{physics::physics_step_s, time::Ps, wire::CanFrame};
use dm4310::Dm4310;
use drive::Drive;
pub(crate) use drive::{DriveFaults, Reception, Shaft};
use mit_frame::Feedback;
use rs00::Rs00;

pub(crate) const JOINTS: usize = 4;
/// Joint angle per shaft angle.
const DIRECTION: [f64; JOINTS] = [1.0, 1.0, -1.0, -1.0];

/// The motor that drives every joint.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum JointKind {
    /// Damiao DM4310.
    #[default]
    Dm4310,
    /// RobStride RS00, set to its MIT protocol.
    Rs00,
}

/// A quantity of a drive that wire events report.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct WireState {
    pub enabled: bool,
    pub commanded_nm: f64,
    pub stop_frames: u64,
}

pub(crate) struct Joint {
    drive: Box<dyn Drive>,
    direction: f64,
}

/// Drives with ESC_ID or motor identifier 1 to 4. DM4310 reply under 0x11 to 0x14, RS00 under the host identifiers 0xF1 to
/// 0xF4.
pub(crate) fn drives(kind: JointKind, rs00_timeout: Ps) -> [Joint; JOINTS] {
    std::array::from_fn(|joint| {
        let id = joint as u32 + 1;
        Joint {
            drive: match kind {
                JointKind::Dm4310 => Box::new(Dm4310::new(id, 0x10 + id)),
                JointKind::Rs00 => Box::new(Rs00::new(id, 0xF0 + id, rs00_timeout)),
            },
            direction: DIRECTION[joint],
        }
    })
}

impl Joint {
    /// The state of the drive's shaft for a joint at this angle and speed.
    pub(crate) fn shaft(&self, pos_rad: f64, vel_rps: f64) -> Shaft {
        Shaft {
            pos_rad: self.direction * pos_rad,
            vel_rps: self.direction * vel_rps,
        }
    }

    pub(crate) fn set_faults(&mut self, faults: DriveFaults, now: Ps) {
        self.drive.set_faults(faults, now);
    }

    pub(crate) fn powered(&self) -> bool {
        self.drive.powered()
    }

    pub(crate) fn receive(&mut self, frame: &CanFrame, shaft: Shaft, now: Ps) -> Reception {
        self.drive.receive(frame, shaft, now)
    }

    pub(crate) fn step(&mut self, shaft: Shaft, supply_v: f64, now: Ps) {
        self.drive.step(shaft, supply_v, now, physics_step_s());
    }

    pub(crate) fn enabled(&self) -> bool {
        self.drive.enabled()
    }

    pub(crate) fn wire_state(&self, shaft: Shaft) -> WireState {
        WireState {
            enabled: self.drive.enabled(),
            commanded_nm: self.drive.commanded_nm(shaft),
            stop_frames: self.drive.stop_frames(),
        }
    }

    /// Time at which the waiting reply requests the bus.
    pub(crate) fn reply_at(&self) -> Option<Ps> {
        self.drive.replies().ready_at()
    }

    pub(crate) fn pending(&self, now: Ps) -> Option<CanFrame> {
        self.drive.replies().pending(now)
    }

    pub(crate) fn sent(&mut self) {
        self.drive.replies_mut().sent();
    }

    pub(crate) fn fed_back(&self) -> Feedback {
        self.drive.replies().on_the_wire()
    }

    /// Torque on the joint, before the friction of the gear.
    pub(crate) fn torque_nm(&self) -> f64 {
        self.direction * self.drive.actuator().torque_nm()
    }

    pub(crate) fn friction_nm(&self) -> f64 {
        self.drive.actuator().rating().friction_nm
    }

    pub(crate) fn temperature_c(&self) -> f64 {
        self.drive.actuator().winding_c()
    }
}
