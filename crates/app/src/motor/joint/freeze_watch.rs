//! Does a motor report what it does now, or repeat something old?

use super::{super::mit::MitTargets, dialect::Report};

/// A joint that turns at least this fast …
const MOVING_RPS: f32 = 0.5;
/// … must show it in its angle within this time.
const STUCK_POSITION_US: u64 = 50_000;
/// Reported torque and the torque that the command asks for differ by more than this …
const ODD_TORQUE_NM: f32 = 1.0;
/// … for this long while nothing in the reports changes.
const STUCK_REPORT_US: u64 = 100_000;

/// Compares each report with the one before it.
#[derive(Clone, Debug, Default)]
pub struct FreezeWatch {
    frozen: bool,
    /// Last report with another angle than the one before.
    position_changed_us: u64,
    /// Last report that differed at all, or agreed with the command.
    plausible_us: u64,
}

impl FreezeWatch {
    /// True if `report`, which comes after `last`, belongs to a frozen series; once frozen, only another report thaws
    /// it. `obeyed` is what an enabled motor was last told in MIT mode.
    pub fn is_frozen(
        &mut self,
        last: &Report,
        report: &Report,
        obeyed: Option<&MitTargets>,
        ts_us: u64,
    ) -> bool {
        let same_position = last.motion.position_code == report.motion.position_code;
        if !same_position {
            self.position_changed_us = ts_us;
        }
        let same_report = same_position && last == report;
        if !same_report || !obeyed.is_some_and(|targets| is_torque_odd(report, targets)) {
            self.plausible_us = ts_us;
        }
        let stuck_position = report.motion.vel_rps.abs() > MOVING_RPS
            && ts_us.saturating_sub(self.position_changed_us) >= STUCK_POSITION_US;
        let stuck_report = ts_us.saturating_sub(self.plausible_us) >= STUCK_REPORT_US;
        self.frozen = stuck_position || stuck_report || (self.frozen && same_report);
        self.frozen
    }

    /// What was reported up to now tells nothing of later reports.
    pub fn restart(&mut self, now_us: u64) {
        *self = Self {
            frozen: false,
            position_changed_us: now_us,
            plausible_us: now_us,
        };
    }
}

fn is_torque_odd(report: &Report, targets: &MitTargets) -> bool {
    let motion = &report.motion;
    let asked_nm = targets.kp * (targets.pos_rad - motion.pos_rad)
        + targets.kd * (targets.vel_rps - motion.vel_rps)
        + targets.torque_nm;
    (asked_nm - motion.torque_nm).abs() > ODD_TORQUE_NM
}
