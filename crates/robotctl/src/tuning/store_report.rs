//! The robot's report on its settings in flash (docs/tuning.md, `31`).

use std::fmt;

use robot_app::domain::{ParamError, ParamState};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StoreReport {
    /// State of the store; `Err` is a number that this tool does not know.
    pub state: Result<ParamState, u8>,
    /// The error of the last attempt that failed since the robot booted.
    pub last_error: Result<ParamError, u8>,
    /// Groups of settings that are not in flash yet.
    pub unsaved: u8,
    /// Records saved since boot; stays at 65535.
    pub save_ok: u16,
    /// Attempts that failed since boot; stays at 65535.
    pub save_failed: u16,
}

impl StoreReport {
    /// Parses the bytes after the command.
    pub(super) fn from_bytes([state, error, unsaved, a, b, c, d]: [u8; 7]) -> Self {
        Self {
            state: ParamState::from_code(state).ok_or(state),
            last_error: ParamError::from_code(error).ok_or(error),
            unsaved,
            save_ok: u16::from_le_bytes([a, b]),
            save_failed: u16::from_le_bytes([c, d]),
        }
    }

    /// True if the robot may be switched off and will boot with its present settings.
    pub fn is_saved(&self) -> bool {
        self.unsaved == 0
    }

    pub fn state_in_words(&self) -> String {
        let words = match self.state {
            Ok(ParamState::Saved) => "saved: flash holds what is in use",
            Ok(ParamState::Settling) => "waits until nothing has changed for half a second",
            Ok(ParamState::WaitingForRest) => {
                "waits until the robot has been disarmed for half a second, its enable switch off; for an erase, also until wheels and joints rest"
            }
            Ok(ParamState::Saving) => "writes",
            Ok(ParamState::Erasing) => "erases a sector",
            Ok(ParamState::BackingOff) => "failed; tries again after 1, 10, 60 or 300 seconds",
            Err(code) => return format!("{code}, which this robotctl does not know"),
        };
        words.to_owned()
    }

    pub fn error_in_words(&self) -> String {
        let words = match self.last_error {
            Ok(ParamError::None) => "none",
            Ok(ParamError::Flash) => "the flash controller reported an error",
            Ok(ParamError::NotProgrammed) => "a record read back differently: worn-out flash",
            Ok(ParamError::NotErased) => "a sector was not blank after its erase: worn-out flash",
            Ok(ParamError::Full) => "no sector is left that can be written: worn-out flash",
            Err(code) => return format!("{code}, which this robotctl does not know"),
        };
        words.to_owned()
    }
}

impl fmt::Display for StoreReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "state            {}", self.state_in_words())?;
        writeln!(f, "unsaved groups   {}", self.unsaved)?;
        writeln!(f, "since boot:")?;
        writeln!(f, "records saved    {}", self.save_ok)?;
        writeln!(f, "failed attempts  {}", self.save_failed)?;
        write!(f, "last error       {}", self.error_in_words())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    // docs/tuning.md: backing off after a record that read back differently, 2 groups, 300 saved, 3 failed.
    #[test]
    fn the_documented_bytes_are_understood() {
        let report = StoreReport::from_bytes([5, 2, 2, 0x2C, 0x01, 3, 0]);
        let expected = StoreReport {
            state: Ok(ParamState::BackingOff),
            last_error: Ok(ParamError::NotProgrammed),
            unsaved: 2,
            save_ok: 300,
            save_failed: 3,
        };
        assert_eq!(report, expected);
        assert!(!report.is_saved());
        assert!(StoreReport::from_bytes([0; 7]).is_saved());
    }

    #[test]
    fn numbers_of_a_later_firmware_are_named_as_such() {
        let report = StoreReport::from_bytes([77, 78, 0, 0, 0, 0, 0]);
        assert!(report.state_in_words().starts_with("77, which"));
        assert!(report.error_in_words().starts_with("78, which"));
    }
}
