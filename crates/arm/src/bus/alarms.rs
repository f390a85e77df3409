//! What a servo says of its own state in every answer.

use std::fmt;

/// The status byte of an answer, and the register of the same meaning. A servo with an alarm still answers, and what it answers
/// is valid.
///
/// Source: the STS3215 memory table, register 65 (servo status), and the manufacturer's SDK.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Alarms(u8);

impl Alarms {
    pub const NONE: Self = Self(0);
    pub const VOLTAGE: Self = Self(1 << 0);
    pub const ANGLE_SENSOR: Self = Self(1 << 1);
    pub const OVERHEAT: Self = Self(1 << 2);
    pub const OVERCURRENT: Self = Self(1 << 3);
    pub const OVERLOAD: Self = Self(1 << 5);

    /// Each alarm with its word and its cure.
    const WORDS: [(Self, &'static str, &'static str); 5] = [
        (
            Self::VOLTAGE,
            "input voltage out of range",
            "compare the supply with the servo's label (7.4 V or 12 V) and with the registers max_voltage and min_voltage; the \
             alarm goes when the voltage is right",
        ),
        (
            Self::ANGLE_SENSOR,
            "angle sensor fault",
            "switch the power off and on; if it stays, the magnet or the sensor is damaged and the servo has to be replaced",
        ),
        (
            Self::OVERHEAT,
            "too hot",
            "let it cool below its register max_temperature (70 °C as shipped), then switch its torque on again",
        ),
        (
            Self::OVERCURRENT,
            "too much current",
            "free the joint, then switch its torque off and on",
        ),
        (
            Self::OVERLOAD,
            "overload",
            "take the load away, then switch its torque off and on (`armctl recover`): it gives little torque until then",
        ),
    ];

    /// Takes a status byte. `None` if it has bits that no servo of this kind sets: such an answer is damaged.
    pub fn from_byte(byte: u8) -> Option<Self> {
        let known = Self::WORDS.iter().fold(0, |all, (alarm, ..)| all | alarm.0);
        (byte & !known == 0).then_some(Self(byte))
    }

    pub fn byte(self) -> u8 {
        self.0
    }

    pub fn is_none(self) -> bool {
        self.0 == 0
    }

    pub fn contains(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }

    /// Returns what to do about each alarm.
    pub fn cures(self) -> impl Iterator<Item = &'static str> {
        self.set().map(|(_, _, cure)| cure)
    }

    fn set(self) -> impl Iterator<Item = (Self, &'static str, &'static str)> {
        let all = Self::WORDS.into_iter();
        all.filter(move |(alarm, ..)| self.contains(*alarm))
    }
}

/// The alarms in words, without cures.
impl fmt::Display for Alarms {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let words: Vec<&str> = self.set().map(|(_, word, _)| word).collect();
        match words[..] {
            [] => write!(f, "none"),
            _ => write!(f, "{}", words.join(", ")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_status_byte_is_told_in_words_with_cures() {
        let alarms = Alarms::from_byte(0x21).expect("known bits");
        assert_eq!(alarms.to_string(), "input voltage out of range, overload");
        assert_eq!(alarms.cures().count(), 2);
        assert_eq!(Alarms::NONE.to_string(), "none");
    }

    #[test]
    fn bits_that_no_servo_sets_are_refused() {
        for byte in [0x10, 0x40, 0x80, 0xFF] {
            assert_eq!(Alarms::from_byte(byte), None, "{byte:#x}");
        }
    }
}
