//! SBUS: 25 bytes at 100 kbaud 8E2, header 0x0F, 16 × 11 bit, flags, footer (hardware.md section 6.1).
//!
//! A header byte may also appear inside a frame, so header and footer alone do not tell where a frame starts.
//! A candidate is trusted if it starts after silence on the line, or right where the frame before it ended. Any other
//! candidate is not delivered; if it looks like a frame it only makes the next one trusted, so a stream without
//! silence is found again at its second frame.
//!
//! Makers put all sorts of footers there: 0x00, the SBUS2 slots, 0x08 (Futaba R7003SB, which sends five bytes more,
//! bolderflight/sbus#79). So after silence header and length are enough, if the bytes came in one run; without silence
//! the footer must be a known one.

use super::channels;

pub(super) const FRAME_LEN: usize = 25;
const HEADER: u8 = 0x0F;
/// 12 bit at 100 kbaud.
const BYTE_US: u64 = 120;
/// Longer silence than any inside a frame, shorter than the shortest between frames (3 ms at a 6 ms period).
const GAP_US: u64 = 2_000;
/// A receiver sends a frame in one run; a pause of two characters inside means that one was lost and another came later.
const BREAK_US: u64 = 2 * BYTE_US;
/// Bytes behind a frame that are no frame's: some receivers add up to seven, which is no fault of the link.
const MAX_TAIL: u32 = 8;

/// One frame as received.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SbusFrame {
    /// 0 … 2047, 172 / 992 / 1811 at −100 / 0 / +100 %.
    pub channels: [u16; 16],
    pub channel_17: bool,
    pub channel_18: bool,
    pub frame_lost: bool,
    pub failsafe: bool,
}

impl SbusFrame {
    /// `None` unless header and footer are those of SBUS or SBUS2.
    pub fn parse(bytes: &[u8; FRAME_LEN]) -> Option<Self> {
        let [.., footer] = bytes;
        if !is_footer(*footer) {
            return None;
        }
        Self::parse_any_footer(bytes)
    }

    /// `None` unless the header is right. A footer that is the next frame's header means that a byte is missing.
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

/// 0x00, the SBUS2 telemetry slots, or that of newer Futaba receivers.
const fn is_footer(byte: u8) -> bool {
    matches!(byte, 0x00 | 0x04 | 0x08 | 0x14 | 0x24 | 0x34)
}

/// What tells that a frame must start at the head of the window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Start {
    /// Nothing.
    Unknown,
    /// The frame before ended there.
    BehindFrame,
    /// Silence before it, and no pause since.
    AfterSilence,
    /// Silence before it, but the bytes since did not come in one run.
    AfterSilenceBroken,
}

/// Finds frames in a byte stream.
#[derive(Clone, Debug)]
pub struct SbusParser {
    window: [u8; FRAME_LEN],
    filled: usize,
    start: Start,
    last_byte_us: Option<u64>,
    discarded_bytes: u32,
    /// Those of them that a damaged or cut frame left.
    lost_bytes: u32,
    /// Discarded since the last frame, while there was no silence and they are few.
    tail: Option<u32>,
}

impl Default for SbusParser {
    fn default() -> Self {
        Self::new()
    }
}

impl SbusParser {
    pub const fn new() -> Self {
        Self {
            window: [0; FRAME_LEN],
            filled: 0,
            start: Start::Unknown,
            last_byte_us: None,
            discarded_bytes: 0,
            lost_bytes: 0,
            tail: None,
        }
    }

    /// Bytes since boot that belonged to no delivered frame.
    pub const fn discarded_bytes(&self) -> u32 {
        self.discarded_bytes
    }

    /// As [`discarded_bytes`](Self::discarded_bytes), without what a receiver adds behind a sound frame.
    pub(super) const fn lost_bytes(&self) -> u32 {
        self.lost_bytes
    }

    /// Takes the bytes that arrived up to `ts_us` (the time of the last one) in chunks of any length.
    pub fn feed(&mut self, bytes: &[u8], ts_us: u64, mut sink: impl FnMut(SbusFrame)) {
        if bytes.is_empty() {
            return;
        }
        self.notice_silence(bytes.len(), ts_us);
        for &byte in bytes {
            if let Some(frame) = self.push(byte) {
                sink(frame);
            }
        }
        self.last_byte_us = Some(ts_us);
    }

    /// As [`feed`](Self::feed) for `count` bytes of which the line damaged at least one: they and the frame begun
    /// before them are dropped.
    pub fn reject(&mut self, count: usize, ts_us: u64) {
        self.discard(self.filled);
        self.tail = None;
        self.count_discarded(count as u32);
        self.start = Start::Unknown;
        self.last_byte_us = Some(ts_us);
    }

    fn notice_silence(&mut self, arrived: usize, ts_us: u64) {
        let line_time_us = (arrived as u64).saturating_mul(BYTE_US);
        let first_byte_us = ts_us.saturating_sub(line_time_us);
        let pause_us = self
            .last_byte_us
            .map_or(u64::MAX, |last| first_byte_us.saturating_sub(last));
        if pause_us >= GAP_US {
            self.discard(self.filled);
            self.tail = None;
            self.start = Start::AfterSilence;
        } else if pause_us > BREAK_US && self.start == Start::AfterSilence {
            self.start = Start::AfterSilenceBroken;
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
            Start::AfterSilence => SbusFrame::parse_any_footer(&self.window),
            _ => SbusFrame::parse(&self.window),
        };
        if frame.is_none() {
            self.start = Start::Unknown;
            self.discard(1);
            self.skip_to_header();
            return None;
        }
        let trusted = self.start != Start::Unknown;
        if trusted {
            self.filled = 0;
            self.tail = Some(0);
        } else {
            self.discard(FRAME_LEN);
        }
        self.start = Start::BehindFrame;
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
            self.start = Start::Unknown;
            self.discard(start);
        }
    }

    /// Drops `count` bytes at the head of the window.
    fn discard(&mut self, count: usize) {
        let count = count.min(self.filled);
        self.window.copy_within(count..self.filled, 0);
        self.filled = self.filled.saturating_sub(count);
        self.count_discarded(count as u32);
    }

    fn count_discarded(&mut self, count: u32) {
        self.discarded_bytes = self.discarded_bytes.wrapping_add(count);
        let tail = self.tail.map(|tail| tail.saturating_add(count));
        self.tail = tail.filter(|tail| *tail <= MAX_TAIL);
        if self.tail.is_none() {
            self.lost_bytes = self.lost_bytes.wrapping_add(tail.unwrap_or(count));
        }
    }
}
