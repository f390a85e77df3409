//! SBUS transmitter side of a receiver: 25 bytes at 100 kbaud 8E2 every 7 ms (docs/hardware.md#sbus).
//!
//! The connector's inverter is on the board, so the MCU pin sees normal polarity.

use super::{faults::RadioFaults, pilot::Pilot};
use crate::{
    time::{MS, Ps},
    wire::{LineFormat, Parity},
};

pub(crate) const PERIOD: Ps = 7 * MS;
pub(crate) const FORMAT: LineFormat = LineFormat {
    baud: 100_000,
    data_bits: 8,
    parity: Parity::Even,
    stop_bits: 2,
};

const HEADER: u8 = 0x0F;
const FOOTER: u8 = 0x00;
const FRAME_LOST: u8 = 1 << 2;
const FAILSAFE: u8 = 1 << 3;
const CENTRE: u16 = 992;

/// The frame for these sticks. A receiver in failsafe behaves in the worst way that is known: it holds the last sticks, and
/// only the flags show the failsafe.
pub(crate) fn frame(pilot: &Pilot, faults: RadioFaults) -> [u8; 25] {
    let mut flags = 0;
    if faults.frame_lost || faults.failsafe {
        flags |= FRAME_LOST;
    }
    if faults.failsafe {
        flags |= FAILSAFE;
    }
    pack(&channels(pilot), flags)
}

/// Channel map of this robot's transmitter: 0 steering (right = high), 1 drive (forward = high), 2 left stick's vertical
/// (up = high), 3 left stick's horizontal (right = high), 4 enable, 5 mode, 6 emergency stop, 7 stand,
/// 8 jump, 9 height (tall = high), 10 roll (right side down = high).
fn channels(pilot: &Pilot) -> [u16; 16] {
    let mut channels = [CENTRE; 16];
    channels[0] = stick(-pilot.wz);
    channels[1] = stick(pilot.vx);
    channels[2] = stick(pilot.left_y);
    channels[3] = stick(pilot.left_x);
    channels[4] = stick(if pilot.enable { 1.0 } else { -1.0 });
    channels[5] = stick(f64::from(pilot.mode) - 1.0);
    channels[6] = stick(if pilot.e_stop { 1.0 } else { -1.0 });
    channels[7] = stick(if pilot.stand { 1.0 } else { -1.0 });
    channels[8] = stick(if pilot.jump { 1.0 } else { -1.0 });
    channels[9] = stick(pilot.height);
    channels[10] = stick(pilot.roll);
    channels
}

/// −1 … 1 to 172 … 992 … 1811.
fn stick(value: f64) -> u16 {
    let span = if value < 0.0 { 820.0 } else { 819.0 };
    (f64::from(CENTRE) + value * span).round() as u16
}

/// 16 channels of 11 bits, least significant bit first.
fn pack(channels: &[u16; 16], flags: u8) -> [u8; 25] {
    let mut frame = [0; 25];
    frame[0] = HEADER;
    for (channel, value) in channels.iter().enumerate() {
        for bit in 0..11 {
            let position = channel * 11 + bit;
            let set = (value >> bit & 1) as u8;
            frame[1 + position / 8] |= set << (position % 8);
        }
    }
    frame[23] = flags;
    frame[24] = FOOTER;
    frame
}

#[cfg(test)]
mod tests {
    use super::*;

    // A vector of docs/hardware.md#test-vectors.
    #[test]
    fn centred_channels_give_the_reference_frame() {
        let expected = [
            0x0F, 0xE0, 0x03, 0x1F, 0xF8, 0xC0, 0x07, 0x3E, 0xF0, 0x81, 0x0F, 0x7C, 0xE0, 0x03,
            0x1F, 0xF8, 0xC0, 0x07, 0x3E, 0xF0, 0x81, 0x0F, 0x7C, 0x00, 0x00,
        ];
        assert_eq!(pack(&[992; 16], 0), expected);
    }

    #[test]
    fn end_points_and_flags_give_the_reference_frame() {
        let mut channels = [992; 16];
        channels[0] = stick(-1.0);
        channels[1] = stick(1.0);
        let expected = [
            0x0F, 0xAC, 0x98, 0x38, 0xF8, 0xC0, 0x07, 0x3E, 0xF0, 0x81, 0x0F, 0x7C, 0xE0, 0x03,
            0x1F, 0xF8, 0xC0, 0x07, 0x3E, 0xF0, 0x81, 0x0F, 0x7C, 0x0C, 0x00,
        ];
        assert_eq!(pack(&channels, FRAME_LOST | FAILSAFE), expected);
    }

    #[test]
    fn left_turn_moves_the_steering_stick_low_and_switches_stand_at_their_ends() {
        let pilot = Pilot {
            enable: true,
            e_stop: false,
            vx: 0.0,
            wz: 1.0,
            left_x: 1.0,
            left_y: -1.0,
            mode: 2,
            stand: true,
            jump: false,
            height: -1.0,
            roll: 1.0,
        };
        let channels = channels(&pilot);
        assert_eq!(
            channels[..11],
            [172, 992, 172, 1811, 1811, 1811, 172, 1811, 172, 172, 1811]
        );
    }
}
