//! The requests of bring-up (docs/bring-up.md).

use std::num::NonZeroI16;

use robot_app::bring_up::BringUpStep as Step;

/// The six motors by their numbers on the wire.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
#[repr(u8)]
pub enum Motor {
    LeftWheel = 0,
    RightWheel = 1,
    LeftFront = 2,
    LeftRear = 3,
    RightFront = 4,
    RightRear = 5,
}

/// The four joints by their numbers on the wire, which are also those of their live pages.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
#[repr(u8)]
pub enum Joint {
    LeftFront = 0,
    LeftRear = 1,
    RightFront = 2,
    RightRear = 3,
}

/// What the motor on trial does while the pilot holds the dead-man stick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Trial {
    /// The torque follows the drive stick.
    Stick,
    /// A torque in mN·m for a joint or a current in mA for a wheel. On the wire, 0 would stand for `Stick`.
    Fixed(NonZeroI16),
    Hold,
}

/// A step of bring-up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BringUpStep {
    Off,
    ReadOnly,
    ZeroTorque,
    OneMotor(Motor, Trial),
}

const TORQUE: u8 = 0;
const HOLD: u8 = 1;

impl BringUpStep {
    /// Returns the bytes after the command: step, motor, action, value, and two that are 0.
    pub(super) fn to_bytes(self) -> [u8; 7] {
        let (step, motor, action, value) = match self {
            Self::Off => (Step::Off, 0, 0, 0),
            Self::ReadOnly => (Step::ReadOnly, 0, 0, 0),
            Self::ZeroTorque => (Step::ZeroTorque, 0, 0, 0),
            Self::OneMotor(motor, trial) => {
                let (action, value) = match trial {
                    Trial::Stick => (TORQUE, 0),
                    Trial::Fixed(value) => (TORQUE, value.get()),
                    Trial::Hold => (HOLD, 0),
                };
                (Step::OneMotor, motor as u8, action, value)
            }
        };
        let [low, high] = value.to_le_bytes();
        [step as u8, motor, action, low, high, 0, 0]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    // docs/bring-up.md: left front joint 0.2 N·m is 40 03 02 00 C8 00 00 00.
    #[test]
    fn steps_are_the_documented_bytes() {
        let bytes = |step: BringUpStep| step.to_bytes();
        let milli = |value| Trial::Fixed(NonZeroI16::new(value).unwrap());
        let fixed = BringUpStep::OneMotor(Motor::LeftFront, milli(200));
        assert_eq!(bytes(fixed), [3, 2, 0, 0xC8, 0, 0, 0]);
        let back = BringUpStep::OneMotor(Motor::RightWheel, milli(-1_000));
        assert_eq!(bytes(back), [3, 1, 0, 0x18, 0xFC, 0, 0]);
        let hold = BringUpStep::OneMotor(Motor::RightRear, Trial::Hold);
        assert_eq!(bytes(hold), [3, 5, 1, 0, 0, 0, 0]);
        assert_eq!(bytes(BringUpStep::ZeroTorque), [2, 0, 0, 0, 0, 0, 0]);
        assert_eq!(bytes(BringUpStep::Off), [0; 7]);
    }
}
