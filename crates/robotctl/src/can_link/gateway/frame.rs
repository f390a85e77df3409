//! A CAN frame in 13 bytes: kind and length, identifier with its highest byte first, eight bytes of data padded with
//! zeros.

use robot_app::domain::{CanFrame, StandardId};

pub const LENGTH: usize = 13;
/// Most bytes of data in a frame.
const MOST: u8 = 8;

pub fn encode(frame: &CanFrame) -> [u8; LENGTH] {
    let payload = frame.payload();
    let mut bytes = [0; LENGTH];
    // No bit set above the length: a data frame with an identifier of 11 bits.
    bytes[0] = payload.len() as u8;
    bytes[3..5].copy_from_slice(&frame.id().raw().to_be_bytes());
    bytes[5..5 + payload.len()].copy_from_slice(payload);
    bytes
}

/// Returns `None` for extended and remote frames, and for what is no frame.
pub fn decode(bytes: &[u8; LENGTH]) -> Option<CanFrame> {
    let [length @ 0..=MOST, 0, 0, id1, id0, data @ ..] = bytes else {
        return None;
    };
    let id = StandardId::new(u16::from_be_bytes([*id1, *id0]))?;
    CanFrame::from_payload(id, data.get(..usize::from(*length))?)
}
