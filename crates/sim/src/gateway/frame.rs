//! A CAN frame in 13 bytes: kind and length, identifier with its highest byte first, eight bytes of data padded with
//! zeros.

use robot_plant::wire::CanFrame;

pub const LENGTH: usize = 13;

const EXTENDED: u8 = 1 << 7;
const REMOTE: u8 = 1 << 6;
const DLC: u8 = 0xF;

pub fn encode(frame: &CanFrame) -> [u8; LENGTH] {
    let kind = (u8::from(frame.extended) * EXTENDED) | (u8::from(frame.remote) * REMOTE);
    let mut bytes = [0; LENGTH];
    bytes[0] = kind | frame.dlc;
    bytes[1..5].copy_from_slice(&frame.id.to_be_bytes());
    if !frame.remote {
        let carried = usize::from(frame.dlc);
        bytes[5..5 + carried].copy_from_slice(&frame.data[..carried]);
    }
    bytes
}

/// Returns `None` if a reserved bit is set, or length or identifier are out of range.
pub fn decode(bytes: &[u8; LENGTH]) -> Option<CanFrame> {
    let [kind, id3, id2, id1, id0, payload @ ..] = *bytes;
    let (extended, remote, dlc) = (kind & EXTENDED != 0, kind & REMOTE != 0, kind & DLC);
    let id = u32::from_be_bytes([id3, id2, id1, id0]);
    let highest = if extended { 0x1FFF_FFFF } else { 0x7FF };
    let reserved = kind & !(EXTENDED | REMOTE | DLC);
    if reserved != 0 || dlc > 8 || id > highest {
        return None;
    }
    let carried = if remote { 0 } else { usize::from(dlc) };
    let mut data = [0; 8];
    data[..carried].copy_from_slice(&payload[..carried]);
    Some(CanFrame {
        id,
        extended,
        remote,
        dlc,
        data,
    })
}
