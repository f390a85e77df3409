//! Checks that a wheel's rotor angle moves as its reported speed says.
//!
//! Two speed controllers with the same number report alternately, each with the angle of its own rotor. A broken
//! angle sensor contradicts the speed derived from it.

use crate::domain::WheelFeedback;

/// Counts of one turn.
const TURN: i32 = 8_192;
/// Counts per microsecond at 1 rpm.
const COUNTS_PER_RPM_US: f32 = TURN as f32 / 60e6;
/// Longer intervals and faster rotors are not checked: frames in between were lost, or arrive too unevenly.
const MAX_INTERVAL_US: u64 = 5_000;
const MAX_RPM: u16 = 1_500;
/// Number of reports that are judged together. A small speed error adds up over them, and a single odd report does
/// not count.
const WINDOW: u8 = 16;
/// Tolerance of the summed deviation, in addition to half of the distance travelled. Frames arrive up to 0.5 ms late.
const TOLERANCE_COUNTS: i32 = 400;
/// Consecutive contradicting windows that set `doubtful`: about 50 ms at 1 kHz.
const RAISE_WINDOWS: u8 = 3;
/// Consecutive consistent windows that clear it.
const CLEAR_WINDOWS: u8 = 16;

/// Compares rotor angle and speed over windows of reports.
#[derive(Clone, Debug, Default)]
pub struct AngleMonitor {
    reports: u8,
    deviation: i32,
    travel: i32,
    /// Consecutive windows that contradict the present value of `doubtful`.
    contrary_windows: u8,
    doubtful: bool,
}

impl AngleMonitor {
    /// Takes the report `now`, which follows `last`. Returns whether angle and speed contradict each other.
    pub fn is_doubtful(&mut self, last: &WheelFeedback, now: &WheelFeedback) -> bool {
        let interval_us = now.ts_us.saturating_sub(last.ts_us);
        if last.ts_us == 0 || interval_us > MAX_INTERVAL_US || now.rpm.unsigned_abs() > MAX_RPM {
            return self.doubtful;
        }
        let expected = (f32::from(now.rpm) * interval_us as f32 * COUNTS_PER_RPM_US) as i32;
        let moved = i32::from(now.rotor_angle).wrapping_sub(last.rotor_angle.into());
        let deviation = wrap_difference(moved.wrapping_sub(expected));
        self.deviation = self.deviation.saturating_add(deviation.abs());
        self.travel = self.travel.saturating_add(expected.abs());
        self.reports = self.reports.saturating_add(1);
        if self.reports >= WINDOW {
            self.evaluate_window();
        }
        self.doubtful
    }

    #[cold]
    fn evaluate_window(&mut self) {
        let allowed = TOLERANCE_COUNTS.saturating_add(self.travel / 2);
        let odd = self.deviation > allowed;
        (self.reports, self.deviation, self.travel) = (0, 0, 0);
        self.contrary_windows = if odd == self.doubtful {
            0
        } else {
            self.contrary_windows.saturating_add(1)
        };
        let needed = if self.doubtful {
            CLEAR_WINDOWS
        } else {
            RAISE_WINDOWS
        };
        if self.contrary_windows >= needed {
            self.doubtful = odd;
            self.contrary_windows = 0;
        }
    }
}

/// Wraps an angle difference to −4096…4095 counts.
fn wrap_difference(counts: i32) -> i32 {
    let half = TURN / 2;
    counts
        .wrapping_add(half)
        .rem_euclid(TURN)
        .wrapping_sub(half)
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Bench {
        watch: AngleMonitor,
        last: WheelFeedback,
    }

    impl Bench {
        fn new() -> Self {
            let last = WheelFeedback {
                ts_us: 1_000_000,
                rotor_angle: 100,
                ..WheelFeedback::default()
            };
            Self {
                watch: AngleMonitor::default(),
                last,
            }
        }

        fn report(&mut self, interval_us: u64, angle: i32, rpm: i16) -> bool {
            let now = WheelFeedback {
                ts_us: self.last.ts_us + interval_us,
                rotor_angle: angle.rem_euclid(TURN) as u16,
                rpm,
                ..WheelFeedback::default()
            };
            let doubtful = self.watch.is_doubtful(&self.last, &now);
            self.last = now;
            doubtful
        }

        /// Sends reports at 1 kHz from a rotor that turns at `true_rpm` and reports `reported_rpm`.
        fn turn(&mut self, reports: u32, true_rpm: f32, reported_rpm: i16) -> bool {
            let mut angle = f64::from(self.last.rotor_angle);
            let mut doubtful = false;
            for _ in 0..reports {
                angle += f64::from(true_rpm) / 60.0 * 8.192;
                doubtful = self.report(1_000, angle as i32, reported_rpm);
            }
            doubtful
        }

        /// Sends alternating reports of two rotors at rest, half a millisecond apart.
        fn alternate(&mut self, reports: u32, angles: [i32; 2]) -> bool {
            let mut doubtful = false;
            for report in 0..reports {
                doubtful = self.report(500, angles[report as usize % 2], 0);
            }
            doubtful
        }
    }

    #[test]
    fn a_consistent_rotor_is_never_doubtful() {
        for rpm in [0, 1, -1, 60, -60, 700, -700, 1_500, -1_500, 9_000, -9_000] {
            let mut bench = Bench::new();
            assert!(!bench.turn(1_000, f32::from(rpm), rpm), "{rpm}");
        }
    }

    /// Arrivals are up to 0.5 ms late, and the speed lags by 30 rpm.
    #[test]
    fn late_reports_are_not_doubtful() {
        let mut bench = Bench::new();
        let mut at = 0.0;
        for report in 0..1_000u64 {
            let late = [0, 500][report as usize % 2];
            at += 1_530.0 / 60.0 * 8.192;
            let interval_us = if late == 0 { 500 } else { 1_500 };
            assert!(!bench.report(interval_us, at as i32, 1_500));
        }
    }

    #[test]
    fn two_senders_are_detected_even_with_similar_angles() {
        for other in [130, 140, 100 + 4_096, 8_000] {
            let mut bench = Bench::new();
            assert!(bench.alternate(60, [100, other]), "{other}");
        }
        let mut bench = Bench::new();
        assert!(!bench.alternate(47, [100, 4_000]));
        assert!(bench.alternate(1, [4_000, 100]));
    }

    #[test]
    fn an_angle_that_contradicts_the_speed_is_detected() {
        for (true_rpm, reported_rpm) in [(200.0, -200), (-200.0, 200), (0.0, 600), (600.0, 0)] {
            let mut bench = Bench::new();
            assert!(
                bench.turn(100, true_rpm, reported_rpm),
                "{true_rpm} {reported_rpm}"
            );
        }
    }

    #[test]
    fn single_odd_reports_are_not_doubtful() {
        let mut bench = Bench::new();
        for _ in 0..100 {
            assert!(!bench.turn(70, 0.0, 0));
            bench.report(1_000, i32::from(bench.last.rotor_angle) + 3_000, 0);
        }
    }

    #[test]
    fn doubt_clears_after_a_quarter_of_a_second_of_consistent_reports() {
        let mut bench = Bench::new();
        assert!(bench.alternate(48, [100, 4_000]));
        assert!(bench.turn(255, 0.0, 0));
        assert!(!bench.turn(1, 0.0, 0));
    }

    #[test]
    fn gaps_and_fast_rotors_are_not_judged() {
        let mut bench = Bench::new();
        for report in 0..500 {
            assert!(!bench.report(5_001, report * 1_000, 0));
            assert!(!bench.report(500, report * 3_333, 1_501));
            assert!(!bench.report(500, report * 3_333, -1_501));
        }
    }
}
