//! One interface for both radio formats, with the quality of the link.

use super::{
    DbusParser, RemoteMapping, SbusParser, dbus, dbus_wheel::DbusWheel,
    glitch_filter::GlitchFilter, mapping, sbus,
};
use crate::domain::{OperatorState, RemoteDiagnostics, RemoteState, RemoteUpdate, age_us};

/// Which receiver is connected to the DBUS connector.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum RemoteFormat {
    /// Futaba SBUS and compatible receivers.
    Sbus,
    /// DJI DR16.
    Dbus,
}

#[derive(Clone, Debug)]
enum Parser {
    Sbus(SbusParser),
    Dbus(DbusParser, DbusWheel),
}

/// Decodes the radio's byte stream into one [`RemoteUpdate`] a frame.
///
/// ```
/// use robot_app::input::{RemoteFormat, RemoteMapping, RemoteReceiver};
///
/// // All sticks centred, all switches at their centre.
/// const FRAME: [u8; 25] = [
///     0x0F, 0xE0, 0x03, 0x1F, 0xF8, 0xC0, 0x07, 0x3E, 0xF0, 0x81, 0x0F, 0x7C, 0xE0, 0x03, 0x1F,
///     0xF8, 0xC0, 0x07, 0x3E, 0xF0, 0x81, 0x0F, 0x7C, 0x00, 0x00,
/// ];
/// let mut receiver = RemoteReceiver::new(RemoteFormat::Sbus, RemoteMapping::default());
/// let mut updates = Vec::new();
/// for frame in 1..=3 {
///     receiver.feed(&FRAME, frame * 14_000, |update| updates.push(update));
/// }
/// assert_eq!(updates.len(), 3);
/// let newest = updates[2];
/// assert_eq!(newest.diagnostics.good_ts_us, 42_000);
/// assert_eq!(newest.state.vx, 0.0);
/// assert!(!newest.operator.enabled);
/// ```
#[derive(Clone, Debug)]
pub struct RemoteReceiver {
    parser: Parser,
    link: Link,
    mapping: RemoteMapping,
}

impl RemoteReceiver {
    /// A receiver that has seen no byte yet.
    pub fn new(format: RemoteFormat, mapping: RemoteMapping) -> Self {
        let parser = match format {
            RemoteFormat::Sbus => Parser::Sbus(SbusParser::new()),
            RemoteFormat::Dbus => Parser::Dbus(DbusParser::new(), DbusWheel::default()),
        };
        Self {
            parser,
            link: Link::default(),
            mapping,
        }
    }

    /// Changes the mapping from the next frame on. Sticks and switches start as they do at boot, as the old mapping
    /// may have put them elsewhere.
    pub fn set_mapping(&mut self, mapping: &RemoteMapping) {
        if self.mapping != *mapping {
            self.mapping = *mapping;
            self.link.reset();
        }
    }

    /// Takes the bytes that arrived up to `ts_us`, the time of the last one, in chunks of any length. `sink` gets one
    /// update for each complete frame.
    pub fn feed(&mut self, bytes: &[u8], ts_us: u64, mut sink: impl FnMut(RemoteUpdate)) {
        let Self {
            parser,
            link,
            mapping,
        } = self;
        match parser {
            Parser::Sbus(parser) => {
                parser.feed(bytes, ts_us, |frame| {
                    let (state, operator) = mapping::from_sbus(&frame, mapping, ts_us);
                    link.raw = frame.channels;
                    let flags = LinkFlags {
                        lost: frame.frame_lost,
                        failsafe: frame.failsafe,
                    };
                    sink(link.accept(state, operator, flags, ts_us));
                });
                link.count_discarded(
                    parser.discarded_bytes(),
                    parser.lost_bytes(),
                    sbus::FRAME_LEN,
                );
            }
            Parser::Dbus(parser, wheel) => {
                parser.feed(bytes, ts_us, |frame| {
                    let (state, operator) = mapping::from_dbus(&frame, wheel, ts_us);
                    link.raw = mapping::raw_of_dbus(&frame);
                    sink(link.accept(state, operator, LinkFlags::default(), ts_us));
                });
                link.count_discarded(
                    parser.discarded_bytes(),
                    parser.discarded_bytes(),
                    dbus::FRAME_LEN,
                );
            }
        }
    }

    /// Takes the place of [`feed`](Self::feed) for `count` bytes among which the UART flagged a parity, framing,
    /// noise or overrun error. No frame with any of them is accepted.
    pub fn reject(&mut self, count: usize, ts_us: u64) {
        let link = &mut self.link;
        link.diagnostics.damaged_bursts = link.diagnostics.damaged_bursts.wrapping_add(1);
        match &mut self.parser {
            Parser::Sbus(parser) => {
                parser.reject(count, ts_us);
                link.count_discarded(
                    parser.discarded_bytes(),
                    parser.lost_bytes(),
                    sbus::FRAME_LEN,
                );
            }
            Parser::Dbus(parser, _) => {
                parser.reject(count, ts_us);
                link.count_discarded(
                    parser.discarded_bytes(),
                    parser.discarded_bytes(),
                    dbus::FRAME_LEN,
                );
            }
        }
    }
}

#[derive(Clone, Copy, Debug, Default)]
struct LinkFlags {
    lost: bool,
    failsafe: bool,
}

/// Frame statistics, and the last values that came over the air.
#[derive(Clone, Debug, Default)]
struct Link {
    diagnostics: RemoteDiagnostics,
    raw: [u16; 16],
    state: RemoteState,
    operator: OperatorState,
    glitch_filter: GlitchFilter,
    /// One bit for each of the last 64 frames, the newest lowest. 1 means lost.
    lost_history: u64,
    /// The part of the parser's lost bytes that the history already counts.
    counted_bytes: u32,
}

impl Link {
    /// Weight of the newest interval in the smoothed frame rate.
    const RATE_GAIN: f32 = 0.1;

    fn accept(
        &mut self,
        state: RemoteState,
        operator: OperatorState,
        flags: LinkFlags,
        ts_us: u64,
    ) -> RemoteUpdate {
        self.update_rate(ts_us);
        let diagnostics = &mut self.diagnostics;
        diagnostics.frames = diagnostics.frames.wrapping_add(1);
        diagnostics.failsafe = flags.failsafe;
        diagnostics.frame_ts_us = ts_us;
        self.push_history(flags.lost);
        let diagnostics = &mut self.diagnostics;
        let good = 64u32.saturating_sub(self.lost_history.count_ones());
        diagnostics.quality = good as f32 / 64.0;
        if flags.lost {
            diagnostics.lost_frames = diagnostics.lost_frames.wrapping_add(1);
        }
        // In lost and failsafe frames the receiver repeats or invents values.
        if !flags.lost && !flags.failsafe {
            diagnostics.good_ts_us = ts_us;
            (self.state, self.operator) = self.glitch_filter.filter(state, operator);
        }
        diagnostics.age_us = age_us(diagnostics.good_ts_us, ts_us);
        RemoteUpdate {
            state: self.state,
            operator: self.operator,
            diagnostics: *diagnostics,
            raw: self.raw,
        }
    }

    fn reset(&mut self) {
        self.state = RemoteState::default();
        self.operator = OperatorState::default();
        self.glitch_filter = GlitchFilter::default();
    }

    /// Updates the counters of bytes outside of frames. Bytes that a damaged or cut frame left count as one lost
    /// frame for each frame length.
    fn count_discarded(&mut self, discarded_bytes: u32, lost_bytes: u32, frame_len: usize) {
        self.diagnostics.discarded_bytes = discarded_bytes;
        let frame_len = frame_len as u32;
        while lost_bytes.wrapping_sub(self.counted_bytes) >= frame_len {
            self.counted_bytes = self.counted_bytes.wrapping_add(frame_len);
            self.push_history(true);
        }
    }

    fn push_history(&mut self, lost: bool) {
        self.lost_history = self.lost_history << 1 | u64::from(lost);
    }

    fn update_rate(&mut self, ts_us: u64) {
        let diagnostics = &mut self.diagnostics;
        if diagnostics.frame_ts_us == 0 {
            return;
        }
        let interval_us = age_us(diagnostics.frame_ts_us, ts_us).max(1);
        let rate_hz = 1_000_000.0 / interval_us as f32;
        diagnostics.frame_rate_hz = if diagnostics.frame_rate_hz == 0.0 {
            rate_hz
        } else {
            diagnostics.frame_rate_hz + Self::RATE_GAIN * (rate_hz - diagnostics.frame_rate_hz)
        };
    }
}

#[cfg(test)]
mod tests;
