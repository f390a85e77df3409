//! DJI DBUS (DT7/DR16): 18 bytes at 100 kbaud 8E1 every 14 ms, without header or checksum (docs/hardware.md#dbus).
//!
//! A frame is exactly 18 bytes after an idle line, with sticks, switches and mouse buttons in range. Anything else is
//! dropped until the next idle line.

use super::channels;

pub(super) const FRAME_LEN: usize = 18;
/// One character has 11 bits at 100 kbaud.
const BYTE_US: u64 = 110;
/// An idle line of this length separates frames. It is longer than any pause inside a frame and shorter than the 12
/// ms between frames.
const IDLE_US: u64 = 2_000;
const CENTRE: u16 = 1024;
/// DJI rejects values further from the centre than this. The sticks end at ±660.
const MAX_OFFSET: u16 = 700;
/// The thumb wheel uses the lower 11 bits of its word.
const WHEEL_BITS: u16 = 0x7FF;

/// A three-position switch of the transmitter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum DbusSwitch {
    /// Away from the pilot.
    Up,
    /// In the middle.
    Middle,
    /// Towards the pilot.
    Down,
}

impl DbusSwitch {
    fn parse(bits: u8) -> Option<Self> {
        match bits & 0x03 {
            1 => Some(Self::Up),
            3 => Some(Self::Middle),
            2 => Some(Self::Down),
            _ => None,
        }
    }
}

/// One received frame. Mouse and keyboard are checked for range and then dropped, as nothing uses them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DbusFrame {
    /// Right horizontal, right vertical, left horizontal, left vertical: 364 / 1024 / 1684 counts at low end, centre
    /// and high end.
    pub sticks: [u16; 4],
    /// The right switch.
    pub right_switch: DbusSwitch,
    /// The left switch.
    pub left_switch: DbusSwitch,
    /// 364 / 1024 / 1684 counts from a transmitter with a thumb wheel. Others send arbitrary values, so it is not
    /// checked.
    pub wheel: u16,
}

impl DbusFrame {
    /// Decodes a frame. Returns `None` if a field is outside what a receiver can send.
    pub fn parse(bytes: &[u8; FRAME_LEN]) -> Option<Self> {
        let [packed @ .., _, _, wheel_low, wheel_high] = bytes;
        let [
            _,
            _,
            _,
            _,
            _,
            switches,
            _,
            _,
            _,
            _,
            _,
            _,
            left_button,
            right_button,
        ] = packed;
        if *left_button > 1 || *right_button > 1 {
            return None;
        }
        let mut sticks = [0; 4];
        for (index, stick) in (0u8..).zip(sticks.iter_mut()) {
            *stick = channels::channel(packed, index);
        }
        let in_range = |value: &u16| value.abs_diff(CENTRE) <= MAX_OFFSET;
        if !sticks.iter().all(in_range) {
            return None;
        }
        Some(Self {
            sticks,
            right_switch: DbusSwitch::parse(switches >> 4)?,
            left_switch: DbusSwitch::parse(switches >> 6)?,
            wheel: u16::from_le_bytes([*wheel_low, *wheel_high]) & WHEEL_BITS,
        })
    }
}

/// Finds frames in a byte stream.
#[derive(Clone, Debug)]
pub struct DbusParser {
    window: [u8; FRAME_LEN],
    filled: usize,
    /// More bytes than one frame arrived without an idle line in between.
    overrun: bool,
    last_byte_us: Option<u64>,
    discarded_bytes: u32,
}

impl Default for DbusParser {
    fn default() -> Self {
        Self::new()
    }
}

impl DbusParser {
    /// A parser that has seen no byte yet.
    pub const fn new() -> Self {
        Self {
            window: [0; FRAME_LEN],
            filled: 0,
            overrun: false,
            last_byte_us: None,
            discarded_bytes: 0,
        }
    }

    /// Number of bytes since boot that belonged to no delivered frame. It wraps.
    pub const fn discarded_bytes(&self) -> u32 {
        self.discarded_bytes
    }

    /// Takes the bytes that arrived up to `ts_us`, the time of the last one, in chunks of any length. `sink` gets
    /// each complete frame.
    pub fn feed(&mut self, bytes: &[u8], ts_us: u64, mut sink: impl FnMut(DbusFrame)) {
        if bytes.is_empty() {
            return;
        }
        self.detect_idle_line(bytes.len(), ts_us);
        for &byte in bytes {
            self.push(byte);
        }
        self.last_byte_us = Some(ts_us);
        if !self.overrun && self.filled == FRAME_LEN {
            match DbusFrame::parse(&self.window) {
                Some(frame) => {
                    self.filled = 0;
                    sink(frame);
                }
                None => self.drop_window(),
            }
            // Bytes that follow without an idle line cannot be a frame.
            self.overrun = true;
        }
    }

    /// Takes the place of [`feed`](Self::feed) for `count` bytes of which at least one was damaged on the line. They
    /// are dropped, and so is everything until the next idle line.
    pub fn reject(&mut self, count: usize, ts_us: u64) {
        self.drop_window();
        self.discarded_bytes = self.discarded_bytes.wrapping_add(count as u32);
        self.overrun = true;
        self.last_byte_us = Some(ts_us);
    }

    fn detect_idle_line(&mut self, arrived: usize, ts_us: u64) {
        let first_byte_us = ts_us.saturating_sub((arrived as u64).saturating_mul(BYTE_US));
        let idle = match self.last_byte_us {
            None => true,
            Some(last) => first_byte_us.saturating_sub(last) >= IDLE_US,
        };
        if idle {
            self.drop_window();
            self.overrun = false;
        }
    }

    fn push(&mut self, byte: u8) {
        match self.window.get_mut(self.filled) {
            Some(slot) if !self.overrun => {
                *slot = byte;
                self.filled = self.filled.saturating_add(1);
            }
            _ => {
                self.overrun = true;
                self.drop_window();
                self.discarded_bytes = self.discarded_bytes.wrapping_add(1);
            }
        }
    }

    fn drop_window(&mut self) {
        self.discarded_bytes = self.discarded_bytes.wrapping_add(self.filled as u32);
        self.filled = 0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CENTRED: [u16; 4] = [CENTRE; 4];
    /// Both switches are in the middle.
    const MIDDLE: u8 = 0b1111;

    /// Packs four sticks of 11 bits, lowest first, then the right switch and the left one.
    fn bytes(sticks: [u16; 4], switches: u8, buttons: [u8; 2]) -> [u8; FRAME_LEN] {
        let mut bits = u64::from(switches) << 44;
        for (place, stick) in (0..).zip(sticks) {
            bits |= u64::from(stick) << (11 * place);
        }
        let mut bytes = [0; FRAME_LEN];
        bytes[..6].copy_from_slice(&bits.to_le_bytes()[..6]);
        bytes[12..14].copy_from_slice(&buttons);
        bytes
    }

    #[test]
    fn a_frame_with_a_stick_out_of_range_is_rejected() {
        for stick in 0..4 {
            for (count, is_frame) in [(323, false), (324, true), (1_724, true), (1_725, false)] {
                let mut sticks = CENTRED;
                sticks[stick] = count;
                let parsed = DbusFrame::parse(&bytes(sticks, MIDDLE, [0, 0]));
                let expected = is_frame.then_some(sticks);
                assert_eq!(parsed.map(|frame| frame.sticks), expected, "{stick}");
            }
        }
    }

    #[test]
    fn switches_and_buttons_accept_only_their_codes() {
        use DbusSwitch::{Down, Middle, Up};
        let parse = |switches, buttons| DbusFrame::parse(&bytes(CENTRED, switches, buttons));
        for (code, expected) in [(0, None), (1, Some(Up)), (2, Some(Down)), (3, Some(Middle))] {
            let right = parse(0b1100 | code, [0, 0]);
            assert_eq!(right.map(|frame| frame.right_switch), expected);
            let left = parse(code << 2 | 0b11, [0, 0]);
            assert_eq!(left.map(|frame| frame.left_switch), expected);
        }
        for (buttons, is_frame) in [([1, 1], true), ([2, 0], false), ([0, 2], false)] {
            assert_eq!(parse(MIDDLE, buttons).is_some(), is_frame, "{buttons:?}");
        }
    }

    #[test]
    fn only_the_lower_eleven_bits_of_the_wheel_are_used() {
        let mut frame = bytes(CENTRED, MIDDLE, [0, 0]);
        frame[16..].copy_from_slice(&[0x34, 0xFA]);
        assert_eq!(DbusFrame::parse(&frame).unwrap().wheel, 0x234);
    }

    /// Returns the number of frames in these bytes, and the bytes discarded since boot.
    fn fed(parser: &mut DbusParser, bytes: &[u8], ts_us: u64) -> (usize, u32) {
        let mut frames = 0;
        parser.feed(bytes, ts_us, |_| frames += 1);
        (frames, parser.discarded_bytes())
    }

    #[test]
    fn after_damage_or_an_overrun_bytes_are_dropped_until_the_line_is_idle() {
        let frame = bytes(CENTRED, MIDDLE, [0, 0]);
        let mut damaged = DbusParser::new();
        damaged.reject(18, 1_000_000);
        assert_eq!(damaged.discarded_bytes(), 18);
        assert_eq!(fed(&mut damaged, &frame, 1_002_000), (0, 36));
        assert_eq!(fed(&mut damaged, &frame, 1_014_000), (1, 36));
        let mut flooded = DbusParser::new();
        let more = [frame.as_slice(), &frame[..5]].concat();
        assert_eq!(fed(&mut flooded, &more, 1_000_000), (0, 23));
        assert_eq!(fed(&mut flooded, &frame, 1_002_000), (0, 41));
        assert_eq!(fed(&mut flooded, &frame, 1_014_000), (1, 41));
    }
}
