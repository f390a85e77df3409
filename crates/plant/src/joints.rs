//! The four leg joints' drives: left front, left rear, right front, right rear.
//!
//! A drive counts in its own sense of rotation and from its own zero. The robot's file says how it sits on the joint.

mod actuator;
mod dm4310;
mod drive;
mod mit_frame;
mod reply;
mod rs00;
mod speed_loop;

use robot_description::JointMotor;

use crate::{physics::physics_step_s, time::Ps, wire::CanFrame};
use dm4310::Dm4310;
use drive::Drive;
pub(crate) use drive::{DriveFaults, Reception, Shaft};
use mit_frame::Feedback;
use rs00::Rs00;

pub(crate) const JOINTS: usize = 4;

/// A quantity of a drive that wire events report.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct WireState {
    pub enabled: bool,
    pub commanded_nm: f64,
    pub stop_frames: u64,
}

#[derive(Clone)]
pub(crate) struct Joint {
    drive: Box<dyn Drive>,
    /// Joint angle per shaft angle.
    direction: f64,
    /// Shaft angle at joint angle 0.
    zero_rad: f64,
}

/// The drives that the robot's file names.
pub(crate) fn drives(joints: &robot_description::Joints, rs00_timeout: Ps) -> [Joint; JOINTS] {
    std::array::from_fn(|joint| {
        let (id, reply) = (joints.ids[joint].into(), joints.replies[joint].into());
        Joint {
            drive: match joints.motor {
                JointMotor::Dm4310 => Box::new(Dm4310::new(id, reply)),
                JointMotor::Rs00 => Box::new(Rs00::new(id, reply, rs00_timeout)),
            },
            direction: joints.directions[joint].into(),
            zero_rad: joints.zeros_rad[joint],
        }
    })
}

impl Joint {
    /// The state of the drive's shaft for a joint at this angle and speed.
    pub(crate) fn shaft(&self, pos_rad: f64, vel_rps: f64) -> Shaft {
        Shaft {
            pos_rad: self.zero_rad + self.direction * pos_rad,
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
