//! Diagnoses a radio line on which no frame arrives.

use super::RemoteFormat;
use crate::domain::{RadioLineHealth, RemoteDiagnostics};

/// Fewer bytes than this between two readings are noise.
const FEW_BYTES: u32 = 20;

/// What the radio line carried between two readings of its counters, about a second apart.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LineDiagnosis {
    /// Frames arrive.
    #[default]
    Frames,
    /// Almost no bytes arrive: there is no receiver, it has no supply, or it is silent without its transmitter.
    Quiet,
    /// Most bursts have line errors: the baud rate differs, or the signal is inverted.
    Errors,
    /// Sound bytes arrive in bursts as long as an SBUS frame, but the image expects DBUS.
    LooksLikeSbus,
    /// Sound bytes arrive in bursts as long as a DBUS frame, but the image expects SBUS.
    LooksLikeDbus,
    /// Sound bytes arrive but form no frames: another protocol.
    OtherProtocol,
}

/// The line's counters at one moment.
#[derive(Clone, Copy, Debug, Default)]
pub struct LineCounters {
    frames: u32,
    bytes: u32,
    bursts: u32,
    errors: u32,
}

impl LineCounters {
    /// Takes a reading of the counters.
    pub fn new(line: &RadioLineHealth, remote: &RemoteDiagnostics) -> Self {
        Self {
            frames: remote.frames,
            bytes: line.rx_bytes,
            bursts: line.rx_events,
            errors: line.errors(),
        }
    }
}

impl LineDiagnosis {
    /// Compares two readings. `format` is what the image expects.
    pub fn between(before: &LineCounters, now: &LineCounters, format: RemoteFormat) -> Self {
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
        // Rounded to a whole byte. A receiver's frames all have the same length.
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

    /// Diagnoses a second with these numbers of frames, bytes, bursts and errors, with counters that have already
    /// wrapped.
    fn after(
        frames: u32,
        bytes: u32,
        bursts: u32,
        errors: u32,
        format: RemoteFormat,
    ) -> LineDiagnosis {
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
            LineCounters::new(&line, &remote)
        };
        let (before, now) = (look(0, 0, 0, 0), look(frames, bytes, bursts, errors));
        LineDiagnosis::between(&before, &now, format)
    }

    #[test]
    fn any_frame_means_that_the_line_works() {
        assert_eq!(
            after(1, 2_500, 100, 90, RemoteFormat::Sbus),
            LineDiagnosis::Frames
        );
    }

    #[test]
    fn a_few_stray_bytes_count_as_a_quiet_line() {
        assert_eq!(after(0, 0, 0, 0, RemoteFormat::Sbus), LineDiagnosis::Quiet);
        assert_eq!(
            after(0, 19, 19, 19, RemoteFormat::Dbus),
            LineDiagnosis::Quiet
        );
    }

    #[test]
    fn bursts_with_errors_mean_wrong_baud_rate_or_polarity() {
        assert_eq!(
            after(0, 2_500, 100, 50, RemoteFormat::Sbus),
            LineDiagnosis::Errors
        );
        assert_eq!(
            after(0, 2_500, 100, 49, RemoteFormat::Sbus),
            LineDiagnosis::OtherProtocol
        );
        assert_eq!(
            after(0, 20, 1, 1, RemoteFormat::Sbus),
            LineDiagnosis::Errors
        );
    }

    #[test]
    fn the_length_of_sound_bursts_reveals_the_other_protocol() {
        assert_eq!(
            after(0, 18 * 71, 71, 0, RemoteFormat::Sbus),
            LineDiagnosis::LooksLikeDbus
        );
        assert_eq!(
            after(0, 25 * 70 + 9, 70, 0, RemoteFormat::Dbus),
            LineDiagnosis::LooksLikeSbus
        );
        assert_eq!(
            after(0, 25 * 70, 70, 0, RemoteFormat::Sbus),
            LineDiagnosis::OtherProtocol
        );
        assert_eq!(
            after(0, 18 * 71, 71, 0, RemoteFormat::Dbus),
            LineDiagnosis::OtherProtocol
        );
        assert_eq!(
            after(0, 32 * 140, 140, 0, RemoteFormat::Sbus),
            LineDiagnosis::OtherProtocol
        );
    }
}
