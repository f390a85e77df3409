//! Which motor sits where: routes feedback in, composes command frames out.

use super::m3508::{self, EscId};
use crate::{
    domain::{BusId, CanFrame, ChassisCommand, MotorCurrent, MotorFeedback, WheelCommand, age_us},
    safety::TorquePermit,
};

/// The bus both wheel motors are on.
pub const WHEEL_BUS: BusId = BusId::Can1;

const fn esc(number: u8) -> EscId {
    match EscId::new(number) {
        Some(id) => id,
        None => unreachable!(),
    }
}

/// Wheel 0 = left, 1 = right. `compose` relies on these being the first two slots of the command group.
const WHEEL_ESCS: [EscId; 2] = [esc(1), esc(2)];

/// Feedback of all motors and the frames that command them.
#[derive(Clone, Debug, Default)]
pub struct MotorManager {
    feedback: MotorFeedback,
}

impl MotorManager {
    /// Takes any received frame; what is no motor feedback leaves no trace.
    pub fn route_frame(&mut self, bus: BusId, frame: &CanFrame, ts_us: u64) {
        if bus != WHEEL_BUS {
            return;
        }
        for (wheel, esc) in self.feedback.wheels.iter_mut().zip(WHEEL_ESCS) {
            if frame.id().raw() == esc.feedback_id()
                && let Some(feedback) = m3508::decode_feedback(frame, ts_us)
            {
                *wheel = feedback;
            }
        }
    }

    /// Feedback with ages brought up to `now_us`.
    pub fn feedback(&mut self, now_us: u64) -> &MotorFeedback {
        for wheel in &mut self.feedback.wheels {
            wheel.age_us = age_us(wheel.ts_us, now_us);
        }
        self.feedback.ts_us = now_us;
        &self.feedback
    }

    /// True if the permit lets any motor move.
    pub fn may_move(permit: Option<&TorquePermit>) -> bool {
        permit.is_some_and(|permit| permit.allows(WHEEL_BUS))
    }

    /// The frame of this tick, and the currents that are in it. Without a permit for the wheels' bus they are exactly
    /// zero, and the frame is sent all the same: a speed controller may hold its last command.
    pub fn compose(
        &self,
        command: &ChassisCommand,
        permit: Option<&TorquePermit>,
        limit_ma: f32,
    ) -> ((BusId, CanFrame), ChassisCommand) {
        let permitted = Self::may_move(permit);
        let [left, right] = command.wheels.map(|wheel| {
            if permitted {
                MotorCurrent::clamped(wheel.current_ma, limit_ma)
            } else {
                MotorCurrent::ZERO
            }
        });
        let frame = m3508::encode_currents([left, right, MotorCurrent::ZERO, MotorCurrent::ZERO]);
        let sent = ChassisCommand {
            wheels: [left, right].map(|current| WheelCommand {
                current_ma: current.ma(),
            }),
            ..ChassisCommand::default()
        };
        ((WHEEL_BUS, frame), sent)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::domain::StandardId;

    fn feedback_frame(id: u16, rpm: i16) -> CanFrame {
        let [high, low] = rpm.to_be_bytes();
        CanFrame::new(StandardId::new(id).unwrap(), [0, 0, high, low, 0, 0, 30, 0])
    }

    #[test]
    fn feedback_reaches_its_wheel_only_from_its_bus() {
        let mut manager = MotorManager::default();
        manager.route_frame(BusId::Can1, &feedback_frame(0x201, 100), 1_000);
        manager.route_frame(BusId::Can1, &feedback_frame(0x202, -100), 2_000);
        manager.route_frame(BusId::Can2, &feedback_frame(0x201, 7), 3_000);
        manager.route_frame(BusId::Can1, &feedback_frame(0x203, 7), 3_000);
        let [left, right] = manager.feedback(5_000).wheels;
        assert_eq!((left.rpm, left.age_us), (100, 4_000));
        assert_eq!((right.rpm, right.age_us), (-100, 3_000));
    }

    #[test]
    fn a_silent_motor_never_looks_fresh() {
        let [left, _] = MotorManager::default().feedback(5).wheels;
        assert_eq!(left.age_us, u32::MAX);
    }

    #[test]
    fn without_a_permit_the_frame_is_all_zero() {
        let command = ChassisCommand {
            wheels: [WheelCommand {
                current_ma: 5_000.0,
            }; 2],
            ..ChassisCommand::default()
        };
        let ((bus, frame), sent) = MotorManager::default().compose(&command, None, 8_000.0);
        assert_eq!((bus, frame.payload()), (BusId::Can1, &[0; 8][..]));
        assert_eq!(sent, ChassisCommand::default());
    }
}
