//! Streams of good, damaged and random bytes.

use robot_test_support::Random;

use super::specification::{Direction, crc8};

/// A frame of the greatest length, many of whose bytes look like headers.
pub fn long_frame(random: &mut Random, direction: Direction) -> Vec<u8> {
    let payload = direction.long_frame() - 2;
    let mut frame = vec![0xFE];
    let headers_among = 1 + random.below(20);
    frame.extend((0..payload).map(|_| byte_or_header(random, headers_among)));
    frame.push(crc8(&frame));
    frame
}

pub fn tunnel_frame(random: &mut Random) -> Vec<u8> {
    let len = random.below(9);
    let mut frame = vec![0xFD, 0xA0 | random.byte() & 0x0F, 7 | (len as u8) << 4];
    frame.extend((0..8).map(|place| if place < len { random.byte() } else { 0 }));
    frame.push(crc8(&frame));
    frame
}

pub fn drive_frame(random: &mut Random) -> Vec<u8> {
    let mut frame = vec![0xFC];
    frame.extend((0..8).map(|_| byte_or_header(random, 4)));
    frame.extend([random.byte() & 1, random.byte()]);
    frame.push(crc8(&frame));
    frame
}

/// One byte in `headers_among` is a header.
pub fn byte_or_header(random: &mut Random, headers_among: usize) -> u8 {
    match random.below(2 * headers_among) {
        0 => 0xFE,
        1 => 0xFD - random.byte() % 2,
        _ => random.byte(),
    }
}

/// Appends a row of good frames, a damaged one, or garbage.
pub fn append_anything(stream: &mut Vec<u8>, random: &mut Random, direction: Direction) {
    let mut frame = match random.below(4) {
        0 => tunnel_frame(random),
        1 if direction == Direction::ToRobot => drive_frame(random),
        _ => long_frame(random, direction),
    };
    let at = random.below(frame.len());
    match random.below(6) {
        0 => {
            let headers_among = 1 + random.below(100);
            let count = random.below(200);
            stream.extend((0..count).map(|_| byte_or_header(random, headers_among)));
            return;
        }
        1 => frame[at] ^= 1 << random.below(8),
        2 => {
            frame.remove(at);
        }
        3 => frame.insert(at, random.byte()),
        4 => frame.truncate(at),
        _ => {}
    }
    stream.extend(frame);
}
