//! One M3508. All wheels share a frame, so its output is a current.

use super::{
    angle_monitor::AngleMonitor,
    interface::Motor,
    m3508::{self, EscId},
};
use crate::domain::{
    CanFrame, MotorCurrent, WheelCommand, WheelControllerConfig, WheelFeedback, age_us,
};

/// A rotor that reports at least this speed must also change its angle.
const MOVING_RPM: u16 = 60;
/// The angle must change within this time.
const STUCK_ANGLE_US: u64 = 50_000;
/// Tolerance between reported and commanded current.
const CURRENT_TOLERANCE_MA: f32 = 1_000.0;
/// Unchanging reports may exceed the tolerance for this long. Then they do not describe the motor's present state.
const STUCK_REPORT_US: u64 = 100_000;

#[derive(Clone, Debug)]
pub struct Wheel {
    esc: EscId,
    max_current_ma: f32,
    feedback: WheelFeedback,
    /// Counts that the rotor has turned since the first report.
    turned_counts: i64,
    sent: MotorCurrent,
    permitted: bool,
    /// Runs only while the wheel may not move: its result forbids arming, and the armed tick has no time to spare.
    angle_monitor: AngleMonitor,
    /// Time of the last report whose angle differed from the previous one, or whose rotor stood.
    angle_plausible_us: u64,
    /// Time of the last report that differed at all, or agreed with the current sent.
    plausible_us: u64,
}

impl Wheel {
    pub fn new(esc: EscId, max_current_ma: f32) -> Self {
        Self {
            esc,
            max_current_ma,
            feedback: WheelFeedback::default(),
            turned_counts: 0,
            sent: MotorCurrent::ZERO,
            permitted: false,
            angle_monitor: AngleMonitor::default(),
            angle_plausible_us: 0,
            plausible_us: 0,
        }
    }

    /// Excludes a stall of the chip from the age of reports.
    pub fn after_stall(&mut self, stall_us: u32) {
        if self.feedback.ts_us == 0 {
            return;
        }
        for ts_us in [
            &mut self.feedback.ts_us,
            &mut self.angle_plausible_us,
            &mut self.plausible_us,
        ] {
            *ts_us = ts_us.saturating_add(stall_us.into());
        }
    }

    /// Counts that the rotor has turned since its first report, 8192 a turn. Between two reports it turns by less than
    /// half a turn, unless reports were lost.
    pub fn turned_counts(&self) -> i64 {
        self.turned_counts
    }

    fn count_turned(&mut self, now: &WheelFeedback) {
        let last = &self.feedback;
        if last.ts_us == 0 {
            return;
        }
        // The angle has 13 bits, so the sign of the difference is in bit 12.
        let turned = now.rotor_angle.wrapping_sub(last.rotor_angle) << 3;
        let turned = i64::from(turned.cast_signed() >> 3);
        self.turned_counts = self.turned_counts.wrapping_add(turned);
    }

    /// Takes the report `now`, which follows `self.feedback`. A frozen state ends only with a different report.
    fn is_frozen(&mut self, now: &WheelFeedback) -> bool {
        let last = &self.feedback;
        let same_angle = now.rotor_angle == last.rotor_angle;
        let same_report = same_angle
            && now.rpm == last.rpm
            && now.current_ma == last.current_ma
            && now.temperature_c == last.temperature_c;
        let implausible_current = (now.current_ma - self.sent.ma()).abs() > CURRENT_TOLERANCE_MA;
        let is_first = last.ts_us == 0;
        let turns = now.rpm.unsigned_abs() >= MOVING_RPM;
        let stuck_angle = if same_angle && turns && !is_first {
            now.ts_us.saturating_sub(self.angle_plausible_us) >= STUCK_ANGLE_US
        } else {
            self.angle_plausible_us = now.ts_us;
            false
        };
        let stuck_report = if same_report && implausible_current && !is_first {
            now.ts_us.saturating_sub(self.plausible_us) >= STUCK_REPORT_US
        } else {
            self.plausible_us = now.ts_us;
            false
        };
        stuck_angle || stuck_report || (self.feedback.frozen && same_report)
    }
}

impl Motor for Wheel {
    type Command = WheelCommand;
    type Config = WheelControllerConfig;
    type Feedback = WheelFeedback;
    type Output = MotorCurrent;

    fn receive(&mut self, frame: &CanFrame, ts_us: u64) -> bool {
        if frame.id() != self.esc.feedback_id() {
            return false;
        }
        let Some(mut feedback) = m3508::decode_feedback(frame, ts_us) else {
            return false;
        };
        self.count_turned(&feedback);
        feedback.frozen = self.is_frozen(&feedback);
        feedback.doubtful = if self.permitted {
            self.feedback.doubtful
        } else {
            self.angle_monitor.is_doubtful(&self.feedback, &feedback)
        };
        self.feedback = feedback;
        true
    }

    fn update_age(&mut self, _timeout_us: u32, now_us: u64) {
        self.feedback.age_us = age_us(self.feedback.ts_us, now_us);
    }

    fn feedback(&self, _config: &WheelControllerConfig, feedback: &mut WheelFeedback) {
        *feedback = self.feedback;
    }

    fn drive(
        &mut self,
        command: &WheelCommand,
        config: &WheelControllerConfig,
        permitted: bool,
        _now_us: u64,
    ) -> MotorCurrent {
        self.permitted = permitted;
        self.sent = if permitted {
            // A NaN limit stays NaN and allows no current.
            let limit_ma = if config.current_limit_ma > self.max_current_ma {
                self.max_current_ma
            } else {
                config.current_limit_ma
            };
            MotorCurrent::clamped(command.current_ma, limit_ma)
        } else {
            MotorCurrent::ZERO
        };
        self.sent
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The smaller of the two limits applies. A NaN limit allows no current.
    #[test]
    fn the_current_is_limited_by_settings_and_layout() {
        for (setting_ma, expected_ma) in [
            (4_000.0, 4_000.0),
            (16_000.0, 10_000.0),
            (f32::INFINITY, 10_000.0),
            (-1.0, 0.0),
            (f32::NAN, 0.0),
        ] {
            let esc = EscId::new(1).unwrap();
            let config = WheelControllerConfig {
                current_limit_ma: setting_ma,
                ..WheelControllerConfig::default()
            };
            let command = WheelCommand {
                current_ma: -30_000.0,
            };
            let mut wheel = Wheel::new(esc, 10_000.0);
            let sent = wheel.drive(&command, &config, true, 0);
            assert_eq!(sent.ma(), -expected_ma, "{setting_ma}");
            assert_eq!(wheel.drive(&command, &config, false, 0).ma(), 0.0);
        }
    }

    /// Angle, rpm, current in counts and temperature of a report.
    type Fields = [i16; 4];

    fn report(wheel: &mut Wheel, [angle, rpm, current, temperature]: Fields, ms: u64) -> bool {
        let ([a, b], [c, d]) = (angle.to_be_bytes(), rpm.to_be_bytes());
        let [e, f] = current.to_be_bytes();
        let frame = CanFrame::new(
            wheel.esc.feedback_id(),
            [a, b, c, d, e, f, temperature as u8, 0],
        );
        assert!(wheel.receive(&frame, 1_000_000 + ms * 1_000));
        wheel.feedback.frozen
    }

    /// A turn has 8192 counts.
    #[test]
    fn turned_counts_go_on_through_the_zero_of_the_rotor() {
        let mut wheel = wheel_with_current(0.0);
        let mut turned = |angle| {
            report(&mut wheel, [angle, 0, 0, 30], 0);
            wheel.turned_counts()
        };
        assert_eq!(turned(8_000), 0, "the first report");
        assert_eq!(turned(8_191), 191);
        assert_eq!(turned(9), 201);
        assert_eq!(turned(8_191), 191);
        assert_eq!(turned(0), 192);
        assert_eq!(turned(4_095), 192 + 4_095);
        assert_eq!(turned(8_190), 192 + 8_190);
        assert_eq!(turned(4_095), 192 + 4_095);
    }

    fn wheel_with_current(current_ma: f32) -> Wheel {
        let mut wheel = Wheel::new(EscId::new(1).unwrap(), 20_000.0);
        send_current(&mut wheel, current_ma);
        wheel
    }

    fn send_current(wheel: &mut Wheel, current_ma: f32) {
        let command = WheelCommand { current_ma };
        wheel.drive(&command, &WheelControllerConfig::default(), true, 0);
    }

    /// Sends a report each millisecond and returns when the first of them counts as frozen, if any does within a
    /// second.
    fn frozen_ms(commanded_ma: f32, fields: impl Fn(u64) -> Fields) -> Option<u64> {
        let mut wheel = wheel_with_current(commanded_ma);
        (0..1_000).find(|ms| report(&mut wheel, fields(*ms), *ms))
    }

    #[test]
    fn the_angle_of_a_turning_rotor_must_change_within_50_ms() {
        for (rpm, expected) in [(59, None), (60, Some(50)), (-60, Some(50)), (-59, None)] {
            assert_eq!(frozen_ms(0.0, |_| [7, rpm, 0, 30]), expected, "{rpm} rpm");
        }
        assert_eq!(frozen_ms(0.0, |ms| [(ms / 49) as i16, 60, 0, 30]), None);
        assert_eq!(frozen_ms(0.0, |ms| [(ms / 51) as i16, 60, 0, 30]), Some(50));
    }

    /// A wheel that stood for long is struck. Its speed shows that before its angle does.
    #[test]
    fn a_wheel_that_begins_to_turn_has_50_ms_as_well() {
        for (turns_ms, expected) in [(49, None), (51, Some(549))] {
            let found = frozen_ms(0.0, |ms| {
                let turning = (500..500 + turns_ms).contains(&ms);
                [7, if turning { 60 } else { 0 }, 0, 30]
            });
            assert_eq!(found, expected, "{turns_ms} ms");
        }
    }

    /// 2441 counts are 2980 mA.
    #[test]
    fn unchanging_reports_must_agree_with_the_current_sent() {
        for (commanded_ma, counts, expected) in [
            (1_000.0, 0, None),
            (1_001.0, 0, Some(100)),
            (-1_001.0, 0, Some(100)),
            (2_980.0, 2_441, None),
            (-2_980.0, 2_441, Some(100)),
        ] {
            let found = frozen_ms(commanded_ma, |_| [7, 0, counts, 30]);
            assert_eq!(found, expected, "{commanded_ma} mA");
        }
        // A change of any field shows that the report is a new one.
        for field in 0..4 {
            let changing = |every: u64| {
                frozen_ms(5_000.0, |ms| {
                    let mut fields = [7, 0, 0, 30];
                    fields[field] += (ms / every) as i16;
                    fields
                })
            };
            assert_eq!(changing(99), None, "field {field}");
            assert_eq!(changing(101), Some(100), "field {field}");
        }
    }

    #[test]
    fn only_a_different_report_ends_a_frozen_wheel() {
        let mut wheel = wheel_with_current(5_000.0);
        for ms in 0..=100 {
            assert_eq!(report(&mut wheel, [7, 0, 0, 30], ms), ms == 100);
        }
        send_current(&mut wheel, 0.0);
        assert!(report(&mut wheel, [7, 0, 0, 30], 101));
        assert!(!report(&mut wheel, [7, 0, 0, 31], 102));
    }

    #[test]
    fn a_stall_neither_ages_reports_nor_freezes_a_wheel() {
        for stall_us in [0, 250_000] {
            let mut wheel = wheel_with_current(0.0);
            wheel.after_stall(stall_us);
            wheel.update_age(0, 1_000_000);
            assert_eq!(wheel.feedback.age_us, u32::MAX, "never heard");
            for ms in 0..=10 {
                report(&mut wheel, [7, 60, 0, 30], ms);
            }
            wheel.after_stall(stall_us);
            wheel.update_age(0, 1_261_000);
            assert_eq!(wheel.feedback.age_us, 251_000 - stall_us);
            assert_eq!(report(&mut wheel, [7, 60, 0, 30], 261), stall_us == 0);
        }
    }
}
