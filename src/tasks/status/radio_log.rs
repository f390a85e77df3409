//! A log line when the reason changes why no radio frames arrive, checked once a second.

use robot_app::diagnostics::DiagnosticsSnapshot;
use robot_app::input::{LineCounters, LineDiagnosis};

use crate::config::REMOTE_FORMAT;

const PERIOD_US: u64 = 1_000_000;

/// The last observation and the last log line.
#[derive(Default)]
pub struct RadioLog {
    look: LineCounters,
    looked_us: u64,
    logged: LineDiagnosis,
}

impl RadioLog {
    pub fn report(&mut self, d: &DiagnosticsSnapshot) {
        if d.ts_us.saturating_sub(self.looked_us) < PERIOD_US {
            return;
        }
        self.looked_us = d.ts_us;
        let now = LineCounters::new(&d.radio_line, &d.remote_diag);
        let before = core::mem::replace(&mut self.look, now);
        let found = LineDiagnosis::between(&before, &now, REMOTE_FORMAT);
        if found == self.logged {
            return;
        }
        self.logged = found;
        match found {
            LineDiagnosis::Frames => defmt::info!("radio: frames arrive"),
            LineDiagnosis::Quiet => defmt::warn!(
                "radio: nothing arrives: receiver not plugged in, without supply, or silent without its transmitter"
            ),
            LineDiagnosis::Errors => defmt::warn!(
                "radio: bytes with errors, no frames: another baud rate (fast SBUS?), or the signal is not inverted as it should be"
            ),
            LineDiagnosis::LooksLikeSbus => defmt::warn!(
                "radio: bytes but no frames: this looks like SBUS, and the image is built for DBUS"
            ),
            LineDiagnosis::LooksLikeDbus => defmt::warn!(
                "radio: bytes but no frames: this looks like DBUS; build the image with ROBOT_REMOTE=dbus"
            ),
            LineDiagnosis::OtherProtocol => {
                defmt::warn!("radio: bytes but no frames: another protocol");
            }
        }
    }
}
