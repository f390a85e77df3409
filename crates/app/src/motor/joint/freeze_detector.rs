//! Detects a motor that repeats an old report.

use super::{super::mit::MitTargets, protocol::Report};

/// A joint that reports at least this speed must also change its angle.
const MOVING_RPS: f32 = 0.5;
/// The angle must change within this time.
const STUCK_POSITION_US: u64 = 50_000;
/// Tolerance between reported torque and the torque that the command asks for.
const TORQUE_TOLERANCE_NM: f32 = 1.0;
/// Unchanging reports may exceed the tolerance for this long.
const STUCK_REPORT_US: u64 = 100_000;

/// Compares each report with the previous one.
#[derive(Clone, Debug, Default)]
pub struct FreezeDetector {
    frozen: bool,
    /// Time of the last report whose angle differed from the previous one, or whose joint stood.
    position_plausible_us: u64,
    /// Time of the last report that differed at all, or agreed with the command.
    plausible_us: u64,
}

impl FreezeDetector {
    /// Takes `report`, which follows `last`, and returns whether it is frozen. A frozen state ends only with a
    /// different report. `active_targets` are the targets that an enabled motor follows in MIT mode.
    pub fn is_frozen(
        &mut self,
        last: &Report,
        report: &Report,
        active_targets: Option<&MitTargets>,
        ts_us: u64,
    ) -> bool {
        let same_position = last.motion.position_code == report.motion.position_code;
        let turns = report.motion.vel_rps.abs() > MOVING_RPS;
        if !same_position || !turns {
            self.position_plausible_us = ts_us;
        }
        let same_report = same_position && last == report;
        if !same_report
            || !active_targets.is_some_and(|targets| is_torque_implausible(report, targets))
        {
            self.plausible_us = ts_us;
        }
        let stuck_position =
            turns && ts_us.saturating_sub(self.position_plausible_us) >= STUCK_POSITION_US;
        let stuck_report = ts_us.saturating_sub(self.plausible_us) >= STUCK_REPORT_US;
        self.frozen = stuck_position || stuck_report || (self.frozen && same_report);
        self.frozen
    }

    /// Forgets all earlier reports.
    pub fn restart(&mut self, now_us: u64) {
        *self = Self {
            frozen: false,
            position_plausible_us: now_us,
            plausible_us: now_us,
        };
    }
}

fn is_torque_implausible(report: &Report, targets: &MitTargets) -> bool {
    let motion = &report.motion;
    let asked_nm = targets.kp * (targets.pos_rad - motion.pos_rad)
        + targets.kd * (targets.vel_rps - motion.vel_rps)
        + targets.torque_nm;
    (asked_nm - motion.torque_nm).abs() > TORQUE_TOLERANCE_NM
}

#[cfg(test)]
mod tests {
    use super::{
        super::{super::mit::MitReport, protocol::Status},
        *,
    };

    fn report(position_code: u16, vel_rps: f32, temperature_c: f32) -> Report {
        Report {
            motion: MitReport {
                position_code,
                pos_rad: 0.1,
                vel_rps,
                torque_nm: 0.0,
            },
            temperature_c,
            status: Status::Enabled,
        }
    }

    fn asks(torque_nm: f32) -> Option<MitTargets> {
        Some(MitTargets {
            torque_nm,
            ..MitTargets::default()
        })
    }

    /// Sends a report each millisecond and returns when the first of them counts as frozen, if any does within a
    /// second.
    fn frozen_ms(
        active_targets: Option<MitTargets>,
        report: impl Fn(u64) -> Report,
    ) -> Option<u64> {
        let mut watch = FreezeDetector::default();
        watch.restart(0);
        (1..1_000).find(|ms| {
            let (last, now) = (report(ms - 1), report(*ms));
            watch.is_frozen(&last, &now, active_targets.as_ref(), ms * 1_000)
        })
    }

    #[test]
    fn the_angle_of_a_turning_joint_must_change_within_50_ms() {
        for (vel_rps, expected) in [
            (0.5, None),
            (0.51, Some(50)),
            (-0.51, Some(50)),
            (-0.5, None),
        ] {
            let found = frozen_ms(None, |_| report(7, vel_rps, 30.0));
            assert_eq!(found, expected, "{vel_rps} rad/s");
        }
        assert_eq!(
            frozen_ms(None, |ms| report((ms / 49) as u16, 2.0, 30.0)),
            None
        );
    }

    /// A joint that stood for long is struck. Its speed shows that before its angle does.
    #[test]
    fn a_joint_that_begins_to_turn_has_50_ms_as_well() {
        for (turns_ms, expected) in [(49, None), (51, Some(549))] {
            let found = frozen_ms(None, |ms| {
                let turning = (500..500 + turns_ms).contains(&ms);
                report((ms / 700) as u16, if turning { 5.0 } else { 0.0 }, 30.0)
            });
            assert_eq!(found, expected, "{turns_ms} ms");
        }
    }

    #[test]
    fn unchanging_reports_must_agree_with_the_command() {
        for (active_targets, expected) in [
            (None, None),
            (asks(1.0), None),
            (asks(1.01), Some(100)),
            (asks(-1.01), Some(100)),
        ] {
            let found = frozen_ms(active_targets, |_| report(7, 0.0, 30.0));
            assert_eq!(found, expected, "{active_targets:?}");
        }
        let warms = |ms: u64| report(7, 0.0, (ms / 99) as f32);
        assert_eq!(frozen_ms(asks(5.0), warms), None);
        let creeps = |ms: u64| report((ms / 99) as u16, 0.0, 30.0);
        assert_eq!(frozen_ms(asks(5.0), creeps), None);
    }

    #[test]
    fn only_a_different_report_or_a_restart_ends_a_frozen_joint() {
        let (old, new) = (report(7, 0.0, 30.0), report(7, 0.0, 31.0));
        let mut watch = FreezeDetector::default();
        let targets = asks(5.0);
        assert!(watch.is_frozen(&old, &old, targets.as_ref(), 100_000));
        assert!(watch.is_frozen(&old, &old, None, 101_000));
        assert!(!watch.is_frozen(&old, &new, None, 102_000));
        assert!(!watch.is_frozen(&new, &new, targets.as_ref(), 201_000));
        watch.restart(201_000);
        assert!(!watch.is_frozen(&new, &new, targets.as_ref(), 300_000));
        assert!(watch.is_frozen(&new, &new, targets.as_ref(), 301_000));
        watch.restart(302_000);
        assert!(!watch.is_frozen(&new, &new, None, 303_000));
    }

    /// 10 · (0.3 − 0.1) + 2 · (0.5 − 1.0) + 0.25 = 1.25 N·m. The tolerance is ±1 N·m.
    #[test]
    fn the_expected_torque_follows_the_motor_s_formula() {
        let targets = MitTargets {
            pos_rad: 0.3,
            vel_rps: 0.5,
            kp: 10.0,
            kd: 2.0,
            torque_nm: 0.25,
        };
        for (torque_nm, odd) in [(0.2, true), (0.3, false), (2.2, false), (2.3, true)] {
            let mut report = report(7, 1.0, 30.0);
            report.motion.torque_nm = torque_nm;
            assert_eq!(is_torque_implausible(&report, &targets), odd, "{torque_nm}");
        }
    }
}
