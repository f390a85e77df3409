//! One M3508. Its current goes out in a frame it shares with others, so its output is a current, not a frame.

use super::{
    angle_watch::AngleWatch,
    interface::Motor,
    m3508::{self, EscId},
};
use crate::domain::{
    CanFrame, MotorCurrent, WheelCommand, WheelControllerConfig, WheelFeedback, age_us,
};

/// A rotor that turns at least this fast …
const MOVING_RPM: u16 = 60;
/// … must show it in its angle within this time.
const STUCK_ANGLE_US: u64 = 50_000;
/// Reported and commanded current differ by more than this …
const ODD_CURRENT_MA: f32 = 1_000.0;
/// … for this long while nothing in the reports changes: they are not about this motor now.
const STUCK_REPORT_US: u64 = 100_000;

#[derive(Clone, Debug)]
pub struct Wheel {
    esc: EscId,
    max_current_ma: f32,
    feedback: WheelFeedback,
    sent: MotorCurrent,
    permitted: bool,
    /// Works while the wheel may not move: what it finds forbids arming, and an armed robot has no time to spare.
    angle_watch: AngleWatch,
    /// Last report with another angle than the one before.
    angle_changed_us: u64,
    /// Last report that differed at all, or agreed with the current sent.
    plausible_us: u64,
}

impl Wheel {
    pub fn new(esc: EscId, max_current_ma: f32) -> Self {
        Self {
            esc,
            max_current_ma,
            feedback: WheelFeedback::default(),
            sent: MotorCurrent::ZERO,
            permitted: false,
            angle_watch: AngleWatch::default(),
            angle_changed_us: 0,
            plausible_us: 0,
        }
    }

    /// Reports are as old as they would be without the stall.
    pub fn after_stall(&mut self, stall_us: u32) {
        if self.feedback.ts_us == 0 {
            return;
        }
        for ts_us in [
            &mut self.feedback.ts_us,
            &mut self.angle_changed_us,
            &mut self.plausible_us,
        ] {
            *ts_us = ts_us.saturating_add(stall_us.into());
        }
    }

    /// `now` is a report, `self.feedback` the one before. Once frozen, only another report thaws it.
    fn is_frozen(&mut self, now: &WheelFeedback) -> bool {
        let last = &self.feedback;
        let same_angle = now.rotor_angle == last.rotor_angle;
        let same_report = same_angle
            && now.rpm == last.rpm
            && now.current_ma == last.current_ma
            && now.temperature_c == last.temperature_c;
        let odd_current = (now.current_ma - self.sent.ma()).abs() > ODD_CURRENT_MA;
        if !same_angle || last.ts_us == 0 {
            self.angle_changed_us = now.ts_us;
        }
        if !same_report || !odd_current || last.ts_us == 0 {
            self.plausible_us = now.ts_us;
        }
        let stuck_angle = now.rpm.unsigned_abs() >= MOVING_RPM
            && now.ts_us.saturating_sub(self.angle_changed_us) >= STUCK_ANGLE_US;
        let stuck_report = now.ts_us.saturating_sub(self.plausible_us) >= STUCK_REPORT_US;
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
        feedback.frozen = self.is_frozen(&feedback);
        feedback.doubtful = if self.permitted {
            self.feedback.doubtful
        } else {
            self.angle_watch.is_doubtful(&self.feedback, &feedback)
        };
        self.feedback = feedback;
        true
    }

    fn watch(&mut self, _timeout_us: u32, now_us: u64) {
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
            // A limit that is no number stays one, and allows nothing.
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

    /// Of settings and layout the smaller limit counts; one that is no number allows nothing.
    #[test]
    fn current_is_limited_by_settings_and_layout() {
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

    /// Angle, rpm, current in counts and temperature, as a report of the first wheel carries them.
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

    fn wheel_told(current_ma: f32) -> Wheel {
        let mut wheel = Wheel::new(EscId::new(1).unwrap(), 20_000.0);
        tell(&mut wheel, current_ma);
        wheel
    }

    fn tell(wheel: &mut Wheel, current_ma: f32) {
        let command = WheelCommand { current_ma };
        wheel.drive(&command, &WheelControllerConfig::default(), true, 0);
    }

    /// Reports each millisecond; when the first of them is taken for frozen, if any is within a second.
    fn frozen_ms(told_ma: f32, fields: impl Fn(u64) -> Fields) -> Option<u64> {
        let mut wheel = wheel_told(told_ma);
        (0..1_000).find(|ms| report(&mut wheel, fields(*ms), *ms))
    }

    #[test]
    fn a_rotor_that_turns_must_show_it_within_50_ms() {
        for (rpm, expected) in [(59, None), (60, Some(50)), (-60, Some(50)), (-59, None)] {
            assert_eq!(frozen_ms(0.0, |_| [7, rpm, 0, 30]), expected, "{rpm} rpm");
        }
        assert_eq!(frozen_ms(0.0, |ms| [(ms / 49) as i16, 60, 0, 30]), None);
        assert_eq!(frozen_ms(0.0, |ms| [(ms / 51) as i16, 60, 0, 30]), Some(50));
    }

    /// 2441 counts are 2980 mA.
    #[test]
    fn a_report_that_never_changes_must_agree_with_the_current_sent() {
        for (told_ma, counts, expected) in [
            (1_000.0, 0, None),
            (1_001.0, 0, Some(100)),
            (-1_001.0, 0, Some(100)),
            (2_980.0, 2_441, None),
            (-2_980.0, 2_441, Some(100)),
        ] {
            let found = frozen_ms(told_ma, |_| [7, 0, counts, 30]);
            assert_eq!(found, expected, "{told_ma} mA");
        }
        // Any field that changes in time shows that the report is of now.
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
    fn only_another_report_thaws_a_frozen_wheel() {
        let mut wheel = wheel_told(5_000.0);
        for ms in 0..=100 {
            assert_eq!(report(&mut wheel, [7, 0, 0, 30], ms), ms == 100);
        }
        tell(&mut wheel, 0.0);
        assert!(report(&mut wheel, [7, 0, 0, 30], 101));
        assert!(!report(&mut wheel, [7, 0, 0, 31], 102));
    }

    #[test]
    fn a_stall_makes_no_report_older_and_no_wheel_frozen() {
        for stall_us in [0, 250_000] {
            let mut wheel = wheel_told(0.0);
            wheel.after_stall(stall_us);
            wheel.watch(0, 1_000_000);
            assert_eq!(wheel.feedback.age_us, u32::MAX, "never heard");
            for ms in 0..=10 {
                report(&mut wheel, [7, 60, 0, 30], ms);
            }
            wheel.after_stall(stall_us);
            wheel.watch(0, 1_261_000);
            assert_eq!(wheel.feedback.age_us, 251_000 - stall_us);
            assert_eq!(report(&mut wheel, [7, 60, 0, 30], 261), stall_us == 0);
        }
    }
}
