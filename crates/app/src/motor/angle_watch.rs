//! Whether a wheel's angle moves as its speed says. Two speed controllers with one number answer in turns, each with the
//! angle of its own rotor; a broken angle sensor contradicts the speed made from it.

use crate::domain::WheelFeedback;

/// Counts of a turn.
const TURN: i32 = 8_192;
/// Counts a microsecond at one revolution a minute.
const COUNTS_PER_RPM_US: f32 = TURN as f32 / 60e6;
/// Reports further apart than this, or faster than this, say nothing: frames between them were lost, or come too unevenly.
const MAX_PAUSE_US: u64 = 5_000;
const MAX_RPM: u16 = 1_500;
/// Reports that are judged together, so that a speed a little off adds up and one odd report does not count.
const WINDOW: u8 = 16;
/// What their angles may deviate in sum, beside half of the distance travelled: frames arrive up to 0.5 ms late.
const SLACK_COUNTS: i32 = 400;
/// Windows in a row that raise a doubt: 50 ms at 1 kHz …
const RAISING: u8 = 3;
/// … and that end it.
const ENDING: u8 = 16;

/// Starts without a doubt.
#[derive(Clone, Debug, Default)]
pub struct AngleWatch {
    reports: u8,
    deviation: i32,
    travel: i32,
    /// Windows in a row that speak against what `doubtful` is.
    against: u8,
    doubtful: bool,
}

impl AngleWatch {
    /// `now` is a report, `last` the one before.
    pub fn is_doubtful(&mut self, last: &WheelFeedback, now: &WheelFeedback) -> bool {
        let pause_us = now.ts_us.saturating_sub(last.ts_us);
        if last.ts_us == 0 || pause_us > MAX_PAUSE_US || now.rpm.unsigned_abs() > MAX_RPM {
            return self.doubtful;
        }
        let expected = (f32::from(now.rpm) * pause_us as f32 * COUNTS_PER_RPM_US) as i32;
        let moved = i32::from(now.rotor_angle).wrapping_sub(last.rotor_angle.into());
        let deviation = shortest(moved.wrapping_sub(expected));
        self.deviation = self.deviation.saturating_add(deviation.abs());
        self.travel = self.travel.saturating_add(expected.abs());
        self.reports = self.reports.saturating_add(1);
        if self.reports >= WINDOW {
            self.conclude();
        }
        self.doubtful
    }

    #[cold]
    fn conclude(&mut self) {
        let allowed = SLACK_COUNTS.saturating_add(self.travel / 2);
        let odd = self.deviation > allowed;
        (self.reports, self.deviation, self.travel) = (0, 0, 0);
        self.against = if odd == self.doubtful {
            0
        } else {
            self.against.saturating_add(1)
        };
        let needed = if self.doubtful { ENDING } else { RAISING };
        if self.against >= needed {
            self.doubtful = odd;
            self.against = 0;
        }
    }
}

/// Into −4096 … 4095.
fn shortest(counts: i32) -> i32 {
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
        watch: AngleWatch,
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
                watch: AngleWatch::default(),
                last,
            }
        }

        fn report(&mut self, pause_us: u64, angle: i32, rpm: i16) -> bool {
            let now = WheelFeedback {
                ts_us: self.last.ts_us + pause_us,
                rotor_angle: angle.rem_euclid(TURN) as u16,
                rpm,
                ..WheelFeedback::default()
            };
            let doubtful = self.watch.is_doubtful(&self.last, &now);
            self.last = now;
            doubtful
        }

        /// A rotor at `true_rpm` that reports `told_rpm` a thousand times a second.
        fn turn(&mut self, reports: u32, true_rpm: f32, told_rpm: i16) -> bool {
            let mut angle = f64::from(self.last.rotor_angle);
            let mut doubtful = false;
            for _ in 0..reports {
                angle += f64::from(true_rpm) / 60.0 * 8.192;
                doubtful = self.report(1_000, angle as i32, told_rpm);
            }
            doubtful
        }

        /// Two rotors at rest that report in turns, half a millisecond apart.
        fn in_turns(&mut self, reports: u32, angles: [i32; 2]) -> bool {
            let mut doubtful = false;
            for report in 0..reports {
                doubtful = self.report(500, angles[report as usize % 2], 0);
            }
            doubtful
        }
    }

    #[test]
    fn a_rotor_that_turns_as_it_says_raises_no_doubt() {
        for rpm in [0, 1, -1, 60, -60, 700, -700, 1_500, -1_500, 9_000, -9_000] {
            let mut bench = Bench::new();
            assert!(!bench.turn(1_000, f32::from(rpm), rpm), "{rpm}");
        }
    }

    /// An arrival up to half a millisecond late, and a speed that lags by 30 rpm.
    #[test]
    fn late_reports_raise_no_doubt() {
        let mut bench = Bench::new();
        let mut at = 0.0;
        for report in 0..1_000u64 {
            let late = [0, 500][report as usize % 2];
            at += 1_530.0 / 60.0 * 8.192;
            let pause_us = if late == 0 { 500 } else { 1_500 };
            assert!(!bench.report(pause_us, at as i32, 1_500));
        }
    }

    #[test]
    fn two_senders_are_noticed_however_little_their_angles_differ() {
        for other in [130, 140, 100 + 4_096, 8_000] {
            let mut bench = Bench::new();
            assert!(bench.in_turns(60, [100, other]), "{other}");
        }
        let mut bench = Bench::new();
        assert!(!bench.in_turns(47, [100, 4_000]));
        assert!(bench.in_turns(1, [4_000, 100]));
    }

    #[test]
    fn an_angle_that_contradicts_the_speed_is_noticed() {
        for (true_rpm, told_rpm) in [(200.0, -200), (-200.0, 200), (0.0, 600), (600.0, 0)] {
            let mut bench = Bench::new();
            assert!(bench.turn(100, true_rpm, told_rpm), "{true_rpm} {told_rpm}");
        }
    }

    #[test]
    fn one_odd_report_now_and_then_raises_no_doubt() {
        let mut bench = Bench::new();
        for _ in 0..100 {
            assert!(!bench.turn(70, 0.0, 0));
            bench.report(1_000, i32::from(bench.last.rotor_angle) + 3_000, 0);
        }
    }

    #[test]
    fn a_doubt_ends_after_a_quarter_of_a_second_of_sense() {
        let mut bench = Bench::new();
        assert!(bench.in_turns(48, [100, 4_000]));
        assert!(bench.turn(255, 0.0, 0));
        assert!(!bench.turn(1, 0.0, 0));
    }

    #[test]
    fn a_gap_or_a_fast_rotor_says_nothing() {
        let mut bench = Bench::new();
        for report in 0..500 {
            assert!(!bench.report(5_001, report * 1_000, 0));
            assert!(!bench.report(500, report * 3_333, 1_501));
            assert!(!bench.report(500, report * 3_333, -1_501));
        }
    }
}
