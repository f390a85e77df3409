//! The reasons for refusing a request.

use crate::motor::NotStationary;

/// Why a request was refused. The numbers are on the wire and never change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum Refusal {
    /// The frame's length does not fit its command.
    WrongLength = 1,
    /// The command is unknown.
    UnknownCommand = 2,
    /// There is no setting, page or joint with this number.
    UnknownParameter = 3,
    /// The field does not allow this value.
    OutOfRange = 4,
    /// The robot is armed or the enable switch is on.
    Armed = 5,
    /// The value is NaN or infinite.
    NotFinite = 6,
    /// The value does not fit another setting.
    Inconsistent = 7,
    /// A sensor with a calibration would be reoriented, which would invalidate the calibration.
    Calibrated = 8,
    /// The joint does not report, repeats an old report, or is not set up.
    JointNotReady = 9,
    /// The joint is turning.
    JointMoving = 10,
    /// The sensors are being recorded, which takes the ticks that the frames would need.
    Recording = 11,
}

impl Refusal {
    const ALL: [Self; 11] = [
        Self::WrongLength,
        Self::UnknownCommand,
        Self::UnknownParameter,
        Self::OutOfRange,
        Self::Armed,
        Self::NotFinite,
        Self::Inconsistent,
        Self::Calibrated,
        Self::JointNotReady,
        Self::JointMoving,
        Self::Recording,
    ];

    /// Its number on the wire.
    pub const fn code(self) -> u8 {
        self as u8
    }

    /// Returns `None` unless `code` comes from [`code`](Self::code).
    pub fn from_code(code: u8) -> Option<Self> {
        Self::ALL.into_iter().find(|reason| reason.code() == code)
    }
}

impl From<NotStationary> for Refusal {
    fn from(reason: NotStationary) -> Self {
        match reason {
            NotStationary::Unknown => Self::JointNotReady,
            NotStationary::Moving => Self::JointMoving,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_documented_codes_are_decoded() {
        let reasons: Vec<_> = (0..=u8::MAX).filter_map(Refusal::from_code).collect();
        assert_eq!(reasons, Refusal::ALL);
        assert_eq!(Refusal::from_code(7), Some(Refusal::Inconsistent));
    }
}
