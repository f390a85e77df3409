//! Either radio format behind one interface, with the quality of the link.

use super::{DbusParser, RemoteMapping, SbusParser, mapping};
use crate::domain::{OperatorState, RemoteDiagnostics, RemoteState, RemoteUpdate, age_us};

/// Which receiver is plugged into the DBUS connector.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum RemoteFormat {
    Sbus,
    Dbus,
}

#[derive(Clone, Debug)]
enum Parser {
    Sbus(SbusParser),
    Dbus(DbusParser),
}

/// Bytes in, one [`RemoteUpdate`] a frame out.
#[derive(Clone, Debug)]
pub struct RemoteReceiver {
    parser: Parser,
    link: Link,
    mapping: RemoteMapping,
}

impl RemoteReceiver {
    pub fn new(format: RemoteFormat, mapping: RemoteMapping) -> Self {
        let parser = match format {
            RemoteFormat::Sbus => Parser::Sbus(SbusParser::new()),
            RemoteFormat::Dbus => Parser::Dbus(DbusParser::new()),
        };
        Self {
            parser,
            link: Link::default(),
            mapping,
        }
    }

    /// Takes the bytes that arrived up to `ts_us` (the time of the last one) in chunks of any length.
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
                    let flags = LinkFlags {
                        lost: frame.frame_lost,
                        failsafe: frame.failsafe,
                    };
                    sink(link.accept(state, operator, flags, ts_us));
                });
                link.diagnostics.discarded_bytes = parser.discarded_bytes();
            }
            Parser::Dbus(parser) => {
                parser.feed(bytes, ts_us, |frame| {
                    let (state, operator) = mapping::from_dbus(&frame, ts_us);
                    sink(link.accept(state, operator, LinkFlags::default(), ts_us));
                });
                link.diagnostics.discarded_bytes = parser.discarded_bytes();
            }
        }
    }
}

#[derive(Clone, Copy, Debug, Default)]
struct LinkFlags {
    lost: bool,
    failsafe: bool,
}

/// Frame statistics and the last values that came over the air.
#[derive(Clone, Debug, Default)]
struct Link {
    diagnostics: RemoteDiagnostics,
    state: RemoteState,
    operator: OperatorState,
    /// One bit a frame, newest lowest, 1 = lost.
    lost_history: u64,
}

impl Link {
    /// Share of the newest interval in the smoothed frame rate.
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
        self.lost_history = self.lost_history << 1 | u64::from(flags.lost);
        let good = 64u32.saturating_sub(self.lost_history.count_ones());
        diagnostics.quality = good as f32 / 64.0;
        if flags.lost {
            diagnostics.lost_frames = diagnostics.lost_frames.wrapping_add(1);
        }
        // In lost and failsafe frames the receiver repeats or invents values.
        if !flags.lost && !flags.failsafe {
            diagnostics.good_ts_us = ts_us;
            self.state = state;
            self.operator = operator;
        }
        diagnostics.age_us = age_us(diagnostics.good_ts_us, ts_us);
        RemoteUpdate {
            state: self.state,
            operator: self.operator,
            diagnostics: *diagnostics,
        }
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
