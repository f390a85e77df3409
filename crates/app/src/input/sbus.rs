//! SBUS: 25 bytes at 100 kbaud 8E2, header 0x0F, 16 × 11 bit, flags, footer (docs/hardware.md#sbus).
//!
//! A header byte may also appear inside a frame, so header and footer alone do not show where a frame starts. A
//! candidate is delivered if it starts after an idle line, or right where the previous frame ended. Any other
//! candidate only synchronises the parser: a stream without idle lines is found again at its second frame.
//!
//! Receivers differ in their footers: 0x00, the SBUS2 slots, 0x08 (Futaba R7003SB, which appends five bytes,
//! bolderflight/sbus#79). After an idle line the header and the length are enough, provided that the bytes came
//! without a pause. Without an idle line the footer must be a known one.

use super::channels;

pub(super) const FRAME_LEN: usize = 25;
const HEADER: u8 = 0x0F;
/// One character has 12 bits at 100 kbaud.
const BYTE_US: u64 = 120;
/// An idle line of this length separates frames. It is longer than any pause inside a frame and shorter than the
/// shortest between frames (3 ms at a 6 ms period).
const IDLE_US: u64 = 2_000;
/// A receiver sends a frame without pauses. A pause of two characters means that one was lost and another came later.
const PAUSE_US: u64 = 2 * BYTE_US;
/// Some receivers append up to seven bytes to a frame. Up to this number of them is no fault of the link.
const MAX_TRAILER: u32 = 8;

/// One received frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SbusFrame {
    /// 0…2047 counts: 172 / 992 / 1811 at −100 / 0 / +100 %.
    pub channels: [u16; 16],
    /// Digital channel 17.
    pub channel_17: bool,
    /// Digital channel 18.
    pub channel_18: bool,
    /// The receiver got no frame over the air in this period and repeats the last one.
    pub frame_lost: bool,
    /// The receiver has lost the transmitter and sends its failsafe values.
    pub failsafe: bool,
}

impl SbusFrame {
    /// Decodes a frame. Returns `None` unless header and footer are those of SBUS or SBUS2.
    pub fn parse(bytes: &[u8; FRAME_LEN]) -> Option<Self> {
        let [.., footer] = bytes;
        if !is_footer(*footer) {
            return None;
        }
        Self::parse_any_footer(bytes)
    }

    /// Decodes a frame with any footer. A footer that equals the header means that a byte is missing and the next
    /// frame has begun.
    fn parse_any_footer(bytes: &[u8; FRAME_LEN]) -> Option<Self> {
        let [header, payload @ .., flags, footer] = bytes;
        if *header != HEADER || *footer == HEADER {
            return None;
        }
        let mut channels = [0; 16];
        for (index, value) in (0u8..).zip(channels.iter_mut()) {
            *value = channels::channel(payload, index);
        }
        Some(Self {
            channels,
            channel_17: flags & 0x01 != 0,
            channel_18: flags & 0x02 != 0,
            frame_lost: flags & 0x04 != 0,
            failsafe: flags & 0x08 != 0,
        })
    }
}

/// 0x00, the SBUS2 telemetry slots, and the footer of newer Futaba receivers.
const fn is_footer(byte: u8) -> bool {
    matches!(byte, 0x00 | 0x04 | 0x08 | 0x14 | 0x24 | 0x34)
}

/// How the start of the window was synchronised to the start of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Sync {
    /// It was not.
    Unsynchronised,
    /// The previous frame ended there.
    AfterFrame,
    /// The line was idle before it, and has not paused since.
    AfterIdle,
    /// The line was idle before it, but has paused since.
    AfterIdleWithPause,
}

/// Finds frames in a byte stream.
#[derive(Clone, Debug)]
pub struct SbusParser {
    window: [u8; FRAME_LEN],
    filled: usize,
    start: Sync,
    last_byte_us: Option<u64>,
    discarded_bytes: u32,
    /// The discarded bytes that came from a damaged or cut frame.
    lost_bytes: u32,
    /// Number of bytes after the last frame, while they can still be a trailer.
    trailer: Option<u32>,
}

impl Default for SbusParser {
    fn default() -> Self {
        Self::new()
    }
}

impl SbusParser {
    /// A parser that has seen no byte yet.
    pub const fn new() -> Self {
        Self {
            window: [0; FRAME_LEN],
            filled: 0,
            start: Sync::Unsynchronised,
            last_byte_us: None,
            discarded_bytes: 0,
            lost_bytes: 0,
            trailer: None,
        }
    }

    /// Number of bytes since boot that belonged to no delivered frame. It wraps.
    pub const fn discarded_bytes(&self) -> u32 {
        self.discarded_bytes
    }

    /// As [`discarded_bytes`](Self::discarded_bytes), without the trailers that a receiver appends to sound frames.
    pub(super) const fn lost_bytes(&self) -> u32 {
        self.lost_bytes
    }

    /// Takes the bytes that arrived up to `ts_us`, the time of the last one, in chunks of any length. `sink` gets
    /// each complete frame.
    pub fn feed(&mut self, bytes: &[u8], ts_us: u64, mut sink: impl FnMut(SbusFrame)) {
        if bytes.is_empty() {
            return;
        }
        self.detect_idle_line(bytes.len(), ts_us);
        for &byte in bytes {
            if let Some(frame) = self.push(byte) {
                sink(frame);
            }
        }
        self.last_byte_us = Some(ts_us);
    }

    /// Takes the place of [`feed`](Self::feed) for `count` bytes of which at least one was damaged on the line. They
    /// are dropped together with the frame begun before them.
    pub fn reject(&mut self, count: usize, ts_us: u64) {
        self.discard(self.filled);
        self.trailer = None;
        self.count_discarded(count as u32);
        self.start = Sync::Unsynchronised;
        self.last_byte_us = Some(ts_us);
    }

    fn detect_idle_line(&mut self, arrived: usize, ts_us: u64) {
        let line_time_us = (arrived as u64).saturating_mul(BYTE_US);
        let first_byte_us = ts_us.saturating_sub(line_time_us);
        let pause_us = self
            .last_byte_us
            .map_or(u64::MAX, |last| first_byte_us.saturating_sub(last));
        if pause_us >= IDLE_US {
            self.discard(self.filled);
            self.trailer = None;
            self.start = Sync::AfterIdle;
        } else if pause_us > PAUSE_US && self.start == Sync::AfterIdle {
            self.start = Sync::AfterIdleWithPause;
        }
    }

    fn push(&mut self, byte: u8) -> Option<SbusFrame> {
        if let Some(slot) = self.window.get_mut(self.filled) {
            *slot = byte;
            self.filled = self.filled.saturating_add(1);
        }
        self.skip_to_header();
        if self.filled < FRAME_LEN {
            return None;
        }
        let frame = match self.start {
            Sync::AfterIdle => SbusFrame::parse_any_footer(&self.window),
            _ => SbusFrame::parse(&self.window),
        };
        if frame.is_none() {
            self.start = Sync::Unsynchronised;
            self.discard(1);
            self.skip_to_header();
            return None;
        }
        let trusted = self.start != Sync::Unsynchronised;
        if trusted {
            self.filled = 0;
            self.trailer = Some(0);
        } else {
            self.discard(FRAME_LEN);
        }
        self.start = Sync::AfterFrame;
        frame.filter(|_| trusted)
    }

    fn skip_to_header(&mut self) {
        let start = self
            .window
            .iter()
            .take(self.filled)
            .position(|&byte| byte == HEADER)
            .unwrap_or(self.filled);
        if start > 0 {
            self.start = Sync::Unsynchronised;
            self.discard(start);
        }
    }

    /// Drops `count` bytes from the front of the window.
    fn discard(&mut self, count: usize) {
        let count = count.min(self.filled);
        self.window.copy_within(count..self.filled, 0);
        self.filled = self.filled.saturating_sub(count);
        self.count_discarded(count as u32);
    }

    fn count_discarded(&mut self, count: u32) {
        self.discarded_bytes = self.discarded_bytes.wrapping_add(count);
        let trailer = self.trailer.map(|trailer| trailer.saturating_add(count));
        self.trailer = trailer.filter(|trailer| *trailer <= MAX_TRAILER);
        if self.trailer.is_none() {
            self.lost_bytes = self.lost_bytes.wrapping_add(trailer.unwrap_or(count));
        }
    }
}
