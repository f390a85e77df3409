//! A command in place of the sticks, PC → robot.

use super::{
    DRIVE_HEADER, TUNNEL_LEN,
    fields::{FrameReader, FrameWriter},
    scale::SHARE,
};
use crate::domain::PcDrive;

const JUMP: u8 = 1 << 0;

/// A drive frame. It is as long as a frame of the tunnel, and its header differs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DriveFrame(pub PcDrive);

impl DriveFrame {
    /// The frame. Every value is limited to −1…1.
    pub fn encode(&self) -> [u8; TUNNEL_LEN] {
        let drive = &self.0;
        let mut frame = FrameWriter::new(DRIVE_HEADER);
        for share in [drive.vx, drive.wz, drive.height, drive.roll] {
            frame.put(SHARE.code16(share));
        }
        frame.put([if drive.jump { JUMP } else { 0 }, drive.count]);
        frame.finish()
    }

    /// Returns `None` if header or CRC is wrong, or a bit is set that has no meaning yet.
    pub fn decode(frame: &[u8; TUNNEL_LEN]) -> Option<Self> {
        let mut fields = FrameReader::new(DRIVE_HEADER, frame)?;
        let [vx, wz, height, roll] = core::array::from_fn(|_| SHARE.value16(fields.take()));
        let [bits, count] = fields.take();
        (bits & !JUMP == 0).then_some(Self(PcDrive {
            vx,
            wz,
            height,
            roll,
            jump: bits & JUMP != 0,
            count,
        }))
    }
}
