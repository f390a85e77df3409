//! Why no frame of the radio arrives, once a second.

use robot_app::diagnostics::DiagnosticsSnapshot;
use robot_app::input::{LineFinding, LineLook};

use crate::config::REMOTE_FORMAT;

const PERIOD_US: u64 = 1_000_000;

/// What was seen and logged last.
#[derive(Default)]
pub struct RadioLog {
    look: LineLook,
    looked_us: u64,
    told: LineFinding,
}

impl RadioLog {
    pub fn report(&mut self, d: &DiagnosticsSnapshot) {
        if d.ts_us.saturating_sub(self.looked_us) < PERIOD_US {
            return;
        }
        self.looked_us = d.ts_us;
        let now = LineLook::new(&d.radio_line, &d.remote_diag);
        let before = core::mem::replace(&mut self.look, now);
        let found = LineFinding::between(&before, &now, REMOTE_FORMAT);
        if found == self.told {
            return;
        }
        self.told = found;
        match found {
            LineFinding::Frames => defmt::info!("radio: frames arrive"),
            LineFinding::Quiet => defmt::warn!(
                "radio: nothing arrives: receiver not plugged in, without supply, or silent without its transmitter"
            ),
            LineFinding::Errors => defmt::warn!(
                "radio: bytes with errors, no frames: another baud rate (fast SBUS?), or the signal is not inverted as it should be"
            ),
            LineFinding::LooksLikeSbus => defmt::warn!(
                "radio: bytes but no frames: this looks like SBUS, and the image is built for DBUS"
            ),
            LineFinding::LooksLikeDbus => defmt::warn!(
                "radio: bytes but no frames: this looks like DBUS; build the image with ROBOT_REMOTE=dbus"
            ),
            LineFinding::OtherProtocol => {
                defmt::warn!("radio: bytes but no frames: another protocol");
            }
        }
    }
}
