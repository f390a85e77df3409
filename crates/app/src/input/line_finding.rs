//! What is wrong with a radio line on which no frame arrives.

use super::RemoteFormat;
use crate::domain::{RadioLineHealth, RemoteDiagnostics};

/// Fewer bytes than this in the time looked at are nothing but noise.
const FEW_BYTES: u32 = 20;

/// What happened between two looks, a second or so apart.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LineFinding {
    /// Frames arrive.
    #[default]
    Frames,
    /// Next to nothing arrives: no receiver, no supply, or it is silent without its transmitter.
    Quiet,
    /// Bytes, but most bursts of them with errors: another baud rate, or the signal is inverted.
    Errors,
    /// Sound bytes in bursts as long as an SBUS frame, on an image for DBUS.
    LooksLikeSbus,
    /// Sound bytes in bursts as long as a DBUS frame, on an image for SBUS.
    LooksLikeDbus,
    /// Sound bytes, and no frames: another protocol.
    OtherProtocol,
}

/// Counters at one look.
#[derive(Clone, Copy, Debug, Default)]
pub struct LineLook {
    frames: u32,
    bytes: u32,
    bursts: u32,
    errors: u32,
}

impl LineLook {
    pub fn new(line: &RadioLineHealth, remote: &RemoteDiagnostics) -> Self {
        Self {
            frames: remote.frames,
            bytes: line.rx_bytes,
            bursts: line.rx_events,
            errors: line.errors(),
        }
    }
}

impl LineFinding {
    /// `format` is what the image expects.
    pub fn between(before: &LineLook, now: &LineLook, format: RemoteFormat) -> Self {
        let since = |now: u32, before: u32| now.wrapping_sub(before);
        let bytes = since(now.bytes, before.bytes);
        let bursts = since(now.bursts, before.bursts);
        let errors = since(now.errors, before.errors);
        if since(now.frames, before.frames) > 0 {
            return Self::Frames;
        }
        if bytes < FEW_BYTES {
            return Self::Quiet;
        }
        if errors >= bursts / 2 && errors > 0 {
            return Self::Errors;
        }
        // To the nearest whole byte: a receiver's frames are all of one length.
        let mean = bytes
            .saturating_add(bursts / 2)
            .checked_div(bursts)
            .unwrap_or(0);
        match (format, mean) {
            (RemoteFormat::Sbus, 18) => Self::LooksLikeDbus,
            (RemoteFormat::Dbus, 25) => Self::LooksLikeSbus,
            _ => Self::OtherProtocol,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A second with this many of each, after counters that had already wrapped.
    fn after(
        frames: u32,
        bytes: u32,
        bursts: u32,
        errors: u32,
        format: RemoteFormat,
    ) -> LineFinding {
        let start = u32::MAX - 3;
        let look = |frames: u32, bytes: u32, bursts: u32, errors: u32| {
            let line = RadioLineHealth {
                rx_bytes: start.wrapping_add(bytes),
                rx_events: start.wrapping_add(bursts),
                parity: start.wrapping_add(errors),
                ..RadioLineHealth::default()
            };
            let remote = RemoteDiagnostics {
                frames: start.wrapping_add(frames),
                ..RemoteDiagnostics::default()
            };
            LineLook::new(&line, &remote)
        };
        let (before, now) = (look(0, 0, 0, 0), look(frames, bytes, bursts, errors));
        LineFinding::between(&before, &now, format)
    }

    #[test]
    fn frames_are_all_that_is_wanted() {
        assert_eq!(
            after(1, 2_500, 100, 90, RemoteFormat::Sbus),
            LineFinding::Frames
        );
    }

    #[test]
    fn a_few_stray_bytes_are_no_receiver() {
        assert_eq!(after(0, 0, 0, 0, RemoteFormat::Sbus), LineFinding::Quiet);
        assert_eq!(after(0, 19, 19, 19, RemoteFormat::Dbus), LineFinding::Quiet);
    }

    #[test]
    fn bursts_with_errors_are_the_wrong_rate_or_polarity() {
        assert_eq!(
            after(0, 2_500, 100, 50, RemoteFormat::Sbus),
            LineFinding::Errors
        );
        assert_eq!(
            after(0, 2_500, 100, 49, RemoteFormat::Sbus),
            LineFinding::OtherProtocol
        );
        assert_eq!(after(0, 20, 1, 1, RemoteFormat::Sbus), LineFinding::Errors);
    }

    #[test]
    fn sound_bursts_tell_the_other_make_by_their_length() {
        assert_eq!(
            after(0, 18 * 71, 71, 0, RemoteFormat::Sbus),
            LineFinding::LooksLikeDbus
        );
        assert_eq!(
            after(0, 25 * 70 + 9, 70, 0, RemoteFormat::Dbus),
            LineFinding::LooksLikeSbus
        );
        assert_eq!(
            after(0, 25 * 70, 70, 0, RemoteFormat::Sbus),
            LineFinding::OtherProtocol
        );
        assert_eq!(
            after(0, 18 * 71, 71, 0, RemoteFormat::Dbus),
            LineFinding::OtherProtocol
        );
        assert_eq!(
            after(0, 32 * 140, 140, 0, RemoteFormat::Sbus),
            LineFinding::OtherProtocol
        );
    }
}
