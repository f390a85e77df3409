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

/// Frames for which the pilot holds the thumb wheel up to ask for standing, 0.3 s.
const WHEEL_FRAMES: u32 = 22;

/// Position of the thumb wheel, up positive. It is held down while the robot is to sit, held up for a moment when it is to
/// stand, and turned up again to jump.
pub(crate) fn wheel(pilot: &Pilot, frames_since_stand: u32) -> f64 {
    let asks = frames_since_stand < WHEEL_FRAMES;
    match (pilot.stand, asks || pilot.jump) {
        (false, _) => -1.0,
        (true, true) => 1.0,
        (true, false) => 0.0,
    }
}

/// The frame for these sticks and this thumb wheel, or `None` while the DR16 has no new packet: its format has no flag for that.
pub(crate) fn frame(pilot: &Pilot, wheel: f64, faults: RadioFaults) -> Option<[u8; 18]> {
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
            stick(other_than_rest(pilot.roll, pilot.left_x)),
            stick(other_than_rest(pilot.height, pilot.left_y)),
        ],
        right,
        left,
        stick(wheel),
    ))
}

/// The left stick sets roll and height while the robot stands, and else serves bring-up.
fn other_than_rest(standing: f64, stick: f64) -> f64 {
    if standing == 0.0 { stick } else { standing }
}

/// −1 … 1 to 364 … 1684.
fn stick(value: f64) -> u16 {
    (f64::from(CENTRE) + value * SPAN).round() as u16
}

/// Right horizontal, right vertical, left horizontal, left vertical, then the switches, then the thumb wheel; mouse
/// and keys at rest.
fn pack(sticks: [u16; 4], right_switch: u8, left_switch: u8, wheel: u16) -> [u8; 18] {
    let mut bits = u64::from(right_switch) << 44 | u64::from(left_switch) << 46;
    for (index, value) in sticks.iter().enumerate() {
        bits |= u64::from(*value) << (11 * index);
    }
    let mut frame = [0; 18];
    frame[..6].copy_from_slice(&bits.to_le_bytes()[..6]);
    frame[16..].copy_from_slice(&wheel.to_le_bytes());
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
        assert_eq!(
            pack([1024; 4], SWITCH_MIDDLE, SWITCH_MIDDLE, CENTRE),
            expected
        );
    }

    #[test]
    fn the_wheel_asks_for_sitting_standing_and_a_jump() {
        let pilot = |stand, jump| Pilot {
            stand,
            jump,
            ..Pilot::default()
        };
        assert_eq!(wheel(&pilot(false, false), 0), -1.0);
        assert_eq!(wheel(&pilot(true, false), 0), 1.0);
        assert_eq!(wheel(&pilot(true, false), WHEEL_FRAMES), 0.0);
        assert_eq!(wheel(&pilot(true, true), WHEEL_FRAMES), 1.0);
    }

    #[test]
    fn end_points_and_switches_give_the_reference_frame() {
        let sticks = [stick(-1.0), stick(1.0), 1024, stick(1.0)];
        let expected = [
            0x6C, 0xA1, 0x34, 0x00, 0x29, 0x9D, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x00, 0x04,
        ];
        assert_eq!(pack(sticks, SWITCH_UP, SWITCH_DOWN, CENTRE), expected);
    }
}
