//! Log lines about the PC link: when a PC comes or goes, and its numbers beside the summary.

use robot_app::diagnostics::{ChangeThrottle, DiagnosticsSnapshot};
use robot_app::domain::LinkHealth;

/// What was logged last.
#[derive(Default)]
pub struct LinkLog {
    present: ChangeThrottle<bool>,
}

impl LinkLog {
    pub fn report_changes(&mut self, d: &DiagnosticsSnapshot) {
        match self.present.due(d.link.rate_hz > 0.0, d.ts_us) {
            Some(true) => defmt::info!("pc link: a PC sends commands"),
            Some(false) => defmt::warn!(
                "pc link: no commands any more, {=u32} good frames and {=u32} CRC errors since boot",
                d.link.good,
                d.link.crc_errors
            ),
            None => {}
        }
    }

    /// Logs the numbers of a line that has carried anything; to be called a few times a second. `age_us` is that of the last
    /// command.
    pub fn report_numbers(&self, d: &DiagnosticsSnapshot, age_us: u64) {
        let LinkHealth {
            good,
            crc_errors,
            resyncs,
            discarded_bytes,
            line_errors,
            rate_hz,
            longest_gap_us,
            ..
        } = d.link;
        if good == 0 && discarded_bytes == 0 && line_errors == 0 {
            return;
        }
        defmt::info!(
            "pc link: {=u32} good, {=u32} CRC errors, {=u32} resyncs, {=u32} line errors | {=u32} Hz, age {=u64} ms, longest gap {=u32} ms",
            good,
            crc_errors,
            resyncs,
            line_errors,
            rate_hz as u32,
            age_us / 1_000,
            longest_gap_us / 1_000
        );
    }
}
