//! Requests to bring-up from the tuning channel.

use super::limits;

/// One of the six motors: 0 and 1 are the wheels, 2 to 5 the joints, each in the order of `ChassisCommand`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TestMotor {
    /// 0 = left, 1 = right.
    Wheel(u8),
    /// 0 to 3, in the order of `ChassisCommand`.
    Joint(u8),
}

impl TestMotor {
    pub(super) const FIRST: Self = Self::Wheel(0);

    /// Returns `None` above 5.
    pub const fn from_number(number: u8) -> Option<Self> {
        match number {
            0 | 1 => Some(Self::Wheel(number)),
            2..=5 => Some(Self::Joint(number.wrapping_sub(2))),
            _ => None,
        }
    }

    /// Its number, 0 to 5.
    pub const fn number(self) -> u8 {
        match self {
            Self::Wheel(index) => index,
            Self::Joint(index) => index.wrapping_add(2),
        }
    }

    pub(super) fn next(self) -> Self {
        Self::from_number(self.number().wrapping_add(1)).unwrap_or(Self::FIRST)
    }

    pub(super) fn previous(self) -> Self {
        Self::from_number(self.number().wrapping_sub(1)).unwrap_or(Self::Joint(3))
    }

    /// Limit of a trial, in mN·m for a joint or mA for a wheel.
    fn limit_milli(self) -> f32 {
        match self {
            Self::Wheel(_) => limits::WHEEL_CURRENT_MA,
            Self::Joint(_) => limits::JOINT_TORQUE_NM * 1_000.0,
        }
    }
}

/// What the selected motor does while the dead-man stick is held.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TrialAction {
    /// The drive stick sets the torque; full stick is the limit of bring-up.
    StickTorque,
    /// A fixed fraction of the limit, −1…1.
    FixedTorque(f32),
    /// A joint is held softly where it was when the dead-man stick was taken; a wheel is braked.
    Hold,
}

/// One motor and its action.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trial {
    /// The motor.
    pub motor: TestMotor,
    /// Its action.
    pub action: TrialAction,
}

/// A step of bring-up and its arguments.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BringUpRequest {
    /// Ends bring-up.
    Off,
    /// First step: nothing may be armed.
    ReadOnly,
    /// Second step: motors are enabled without torque.
    ZeroTorque,
    /// Third step: one motor gives a little torque.
    OneMotor(Trial),
}

impl BringUpRequest {
    /// Decodes the fields of a tuning frame. `value` is in mN·m for a joint and mA for a wheel; with 0 the drive
    /// stick decides. Fields that a step does not use must be 0. Returns `None` for an invalid request, including a
    /// value beyond the limit.
    pub fn from_fields(step: u8, motor: u8, action: u8, value: i16) -> Option<Self> {
        match (step, motor, action, value) {
            (0, 0, 0, 0) => Some(Self::Off),
            (1, 0, 0, 0) => Some(Self::ReadOnly),
            (2, 0, 0, 0) => Some(Self::ZeroTorque),
            (3, _, _, _) => {
                let motor = TestMotor::from_number(motor)?;
                let action = TrialAction::from_fields(motor, action, value)?;
                Some(Self::OneMotor(Trial { motor, action }))
            }
            _ => None,
        }
    }
}

impl TrialAction {
    fn from_fields(motor: TestMotor, action: u8, value: i16) -> Option<Self> {
        match (action, value) {
            (0, 0) => Some(Self::StickTorque),
            (0, _) => {
                let share = f32::from(value) / motor.limit_milli();
                (share.abs() <= 1.0).then_some(Self::FixedTorque(share))
            }
            (1, 0) => Some(Self::Hold),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_six_motors_form_a_ring() {
        let mut motor = TestMotor::FIRST;
        let numbers: Vec<u8> = (0..7)
            .map(|_| {
                let number = motor.number();
                motor = motor.next();
                assert_eq!(motor.previous().number(), number);
                number
            })
            .collect();
        assert_eq!(numbers, [0, 1, 2, 3, 4, 5, 0]);
        assert_eq!(TestMotor::from_number(2), Some(TestMotor::Joint(0)));
        assert_eq!(TestMotor::from_number(6), None);
    }

    #[test]
    fn torque_is_accepted_up_to_the_bring_up_limit() {
        let share = |motor, value| match BringUpRequest::from_fields(3, motor, 0, value) {
            Some(BringUpRequest::OneMotor(Trial {
                action: TrialAction::FixedTorque(share),
                ..
            })) => Some(share),
            _ => None,
        };
        assert_eq!(share(2, 500), Some(1.0));
        assert_eq!(share(2, -250), Some(-0.5));
        assert_eq!(share(2, 501), None);
        assert_eq!(share(2, i16::MIN), None);
        assert_eq!(share(1, 1_000), Some(1.0));
        assert_eq!(share(1, 1_001), None);
    }

    #[test]
    fn zero_torque_selects_the_stick_and_one_motor_may_be_held() {
        for (action, expected) in [(0, TrialAction::StickTorque), (1, TrialAction::Hold)] {
            for motor in 0..6 {
                let trial = Trial {
                    motor: TestMotor::from_number(motor).unwrap(),
                    action: expected,
                };
                let request = BringUpRequest::from_fields(3, motor, action, 0);
                assert_eq!(request, Some(BringUpRequest::OneMotor(trial)));
            }
        }
    }

    #[test]
    fn invalid_requests_are_rejected() {
        let nonsense = [
            (4, 0, 0, 0),
            (3, 6, 0, 0),
            (3, 2, 2, 0),
            (3, 2, 1, 5),
            (1, 1, 0, 0),
        ];
        for (step, motor, action, value) in nonsense {
            assert_eq!(
                BringUpRequest::from_fields(step, motor, action, value),
                None
            );
        }
    }
}
