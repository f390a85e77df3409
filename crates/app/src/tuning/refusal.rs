//! Why a request changed nothing.

use crate::motor::NotStationary;

/// The numbers are on the wire and never change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum Refusal {
    /// The frame is shorter or longer than its command.
    WrongLength = 1,
    UnknownCommand = 2,
    UnknownParameter = 3,
    /// Not a value this field may take.
    OutOfRange = 4,
    /// The robot is armed or the enable switch is on.
    Armed = 5,
    /// NaN or infinite.
    NotFinite = 6,
    /// Fits alone but not together with another setting.
    Inconsistent = 7,
    /// A sensor would be turned whose calibration is for how it was.
    Calibrated = 8,
    /// The joint does not report, repeats an old report, or is not set up.
    JointNotReady = 9,
    /// The joint turns.
    JointTurns = 10,
}

impl Refusal {
    const ALL: [Self; 10] = [
        Self::WrongLength,
        Self::UnknownCommand,
        Self::UnknownParameter,
        Self::OutOfRange,
        Self::Armed,
        Self::NotFinite,
        Self::Inconsistent,
        Self::Calibrated,
        Self::JointNotReady,
        Self::JointTurns,
    ];

    pub const fn code(self) -> u8 {
        self as u8
    }

    /// `None` unless `code` is one that [`code`](Self::code) gives.
    pub fn from_code(code: u8) -> Option<Self> {
        Self::ALL.into_iter().find(|reason| reason.code() == code)
    }
}

impl From<NotStationary> for Refusal {
    fn from(reason: NotStationary) -> Self {
        match reason {
            NotStationary::Unknown => Self::JointNotReady,
            NotStationary::Moving => Self::JointTurns,
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
