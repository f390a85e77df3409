//! DJI DR16 receiver: 18 bytes at 100 kbaud 8E1 every 14 ms, no header, no checksum (docs/hardware.md#dbus).

use super::{faults::RadioFaults, pilot::Pilot};
use crate::{
    time::{MS, Ps},
    wire::{LineFormat, Parity},
};

pub(crate) const PERIOD: Ps = 14 * MS;
pub(crate) const FORMAT: LineFormat = LineFormat {
    baud: 100_000,
    data_bits: 8,
    parity: Parity::Even,
    stop_bits: 1,
};

const CENTRE: u16 = 1024;
const SPAN: f64 = 660.0;
const SWITCH_UP: u8 = 1;
const SWITCH_DOWN: u8 = 2;
const SWITCH_MIDDLE: u8 = 3;

/// The frame for these sticks, or `None` while the DR16 has no new packet: its format has no flag for that.
pub(crate) fn frame(pilot: &Pilot, faults: RadioFaults) -> Option<[u8; 18]> {
    if faults.failsafe || faults.frame_lost {
        return None;
    }
    let right = match (pilot.e_stop, pilot.enable) {
        (true, _) => SWITCH_DOWN,
        (false, true) => SWITCH_UP,
        (false, false) => SWITCH_MIDDLE,
    };
    let left = match pilot.mode {
        0 => SWITCH_UP,
        1 => SWITCH_MIDDLE,
        _ => SWITCH_DOWN,
    };
    Some(pack(
        [
            stick(-pilot.wz),
            stick(pilot.vx),
            stick(pilot.left_x),
            stick(pilot.left_y),
        ],
        right,
        left,
    ))
}

/// −1 … 1 to 364 … 1684.
fn stick(value: f64) -> u16 {
    (f64::from(CENTRE) + value * SPAN).round() as u16
}

/// Right horizontal, right vertical, left horizontal, left vertical, then the switches; mouse and keys at rest, the
/// thumb wheel centred.
fn pack(sticks: [u16; 4], right_switch: u8, left_switch: u8) -> [u8; 18] {
    let mut bits = u64::from(right_switch) << 44 | u64::from(left_switch) << 46;
    for (index, value) in sticks.iter().enumerate() {
        bits |= u64::from(*value) << (11 * index);
    }
    let mut frame = [0; 18];
    frame[..6].copy_from_slice(&bits.to_le_bytes()[..6]);
    frame[16..].copy_from_slice(&CENTRE.to_le_bytes());
    frame
}

#[cfg(test)]
mod tests {
    use super::*;

    // A vector of docs/hardware.md#test-vectors.
    #[test]
    fn centred_sticks_and_middle_switches_give_the_reference_frame() {
        let expected = [
            0x00, 0x04, 0x20, 0x00, 0x01, 0xF8, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x00, 0x04,
        ];
        assert_eq!(pack([1024; 4], SWITCH_MIDDLE, SWITCH_MIDDLE), expected);
    }

    #[test]
    fn end_points_and_switches_give_the_reference_frame() {
        let sticks = [stick(-1.0), stick(1.0), 1024, stick(1.0)];
        let expected = [
            0x6C, 0xA1, 0x34, 0x00, 0x29, 0x9D, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x00, 0x04,
        ];
        assert_eq!(pack(sticks, SWITCH_UP, SWITCH_DOWN), expected);
    }
}
