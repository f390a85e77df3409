//! Targets for the motors, PC → robot.

use super::{
    HEADER,
    fields::{FrameReader, FrameWriter},
    scale::{GAIN, JOINT_TARGET, WHEEL_TARGET},
};
use crate::domain::{JointTarget, WheelTarget};

/// Length of a command frame.
pub const DOWNLINK_LEN: usize = 38;

/// One command for all motors. Any bits are a command within the ranges of the fields.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Downlink {
    /// Left, right.
    pub wheels: [WheelTarget; 2],
    /// Left front, left rear, right front, right rear.
    pub joints: [JointTarget; 4],
}

impl Downlink {
    /// The frame. Every value is limited to the range of its field.
    pub fn encode(&self) -> [u8; DOWNLINK_LEN] {
        let mut frame = FrameWriter::new(HEADER);
        for wheel in &self.wheels {
            frame.put(WHEEL_TARGET.code16(wheel.speed_rps));
            frame.put(GAIN.code16(wheel.kp));
            frame.put(GAIN.code16(wheel.kd));
        }
        for joint in &self.joints {
            frame.put(JOINT_TARGET.code16(joint.pos_rad));
            frame.put(GAIN.code16(joint.kp));
            frame.put(GAIN.code16(joint.kd));
        }
        frame.finish()
    }

    /// Returns `None` if header or CRC is wrong.
    pub fn decode(frame: &[u8; DOWNLINK_LEN]) -> Option<Self> {
        let mut fields = FrameReader::new(HEADER, frame)?;
        // Fields are evaluated in the order in which they are written here.
        Some(Self {
            wheels: core::array::from_fn(|_| WheelTarget {
                speed_rps: WHEEL_TARGET.value16(fields.take()),
                kp: GAIN.value16(fields.take()),
                kd: GAIN.value16(fields.take()),
            }),
            joints: core::array::from_fn(|_| JointTarget {
                pos_rad: JOINT_TARGET.value16(fields.take()),
                kp: GAIN.value16(fields.take()),
                kd: GAIN.value16(fields.take()),
            }),
        })
    }
}
