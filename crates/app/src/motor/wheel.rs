//! One M3508. Its current goes out in a frame it shares with others, so its output is a current, not a frame.

use super::{
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
}
