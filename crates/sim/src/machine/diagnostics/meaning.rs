//! The meaning of the numbers in a diagnostic, by the names that the firmware uses.

use std::collections::BTreeMap;

/// Names of a signal's values.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Meaning {
    /// An enum: value → variant.
    States(BTreeMap<u64, String>),
    /// A set of flags: bit → name.
    Flags(BTreeMap<u8, String>),
}

impl Meaning {
    /// Name of a flag by its bit. `None` for a bit without a name, and for values that are not flags.
    pub fn bit(&self, bit: u8) -> Option<&str> {
        match self {
            Self::States(_) => None,
            Self::Flags(names) => names.get(&bit).map(String::as_str),
        }
    }

    /// The value as text: a variant, or the flags that are set. `None` if a name is missing.
    pub fn words(&self, value: f64) -> Option<String> {
        let number = value as u64;
        if value.fract() != 0.0 || value < 0.0 {
            return None;
        }
        match self {
            Self::States(names) => names.get(&number).cloned(),
            Self::Flags(_) if number == 0 => Some("none".to_owned()),
            Self::Flags(_) => {
                let set = (0..64_u8).filter(|bit| number >> bit & 1 == 1);
                let names: Option<Vec<&str>> = set.map(|bit| self.bit(bit)).collect();
                names.map(|names| names.join(" "))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_put_into_words() {
        let states = Meaning::States([(0, "Run".to_owned()), (2, "Stop".to_owned())].into());
        assert_eq!(states.words(2.0).as_deref(), Some("Stop"));
        assert_eq!(states.words(1.0), None);
        assert_eq!(states.bit(0), None);
        let flags = Meaning::Flags([(1, "lost".to_owned()), (3, "e-stop".to_owned())].into());
        assert_eq!(flags.words(10.0).as_deref(), Some("lost e-stop"));
        assert_eq!(flags.words(0.0).as_deref(), Some("none"));
        assert_eq!(flags.words(1.0), None);
        assert_eq!(flags.bit(3), Some("e-stop"));
    }
}
