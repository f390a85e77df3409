//! State of the parameter store, and its requests to the control tick.

/// Activity of the store.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum ParamState {
    /// Flash holds the settings in use.
    #[default]
    Saved = 0,
    /// Something changed. It is saved when nothing has changed for 500 ms.
    Settling = 1,
    /// The robot is armed or motors may be turning, so flash is not written.
    WaitingForRest = 2,
    /// A record is being written.
    Saving = 3,
    /// A sector is being erased, during which the chip stands still.
    Erasing = 4,
    /// The last attempt failed. The next one comes after 1, 10, 60 or 300 s.
    BackingOff = 5,
}

impl ParamState {
    const ALL: [Self; 6] = [
        Self::Saved,
        Self::Settling,
        Self::WaitingForRest,
        Self::Saving,
        Self::Erasing,
        Self::BackingOff,
    ];

    /// Decodes a number from the wire (docs/tuning.md). The numbers never change.
    pub fn from_code(code: u8) -> Option<Self> {
        Self::ALL.into_iter().find(|state| *state as u8 == code)
    }
}

/// Why an attempt failed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum ParamError {
    /// No attempt has failed.
    #[default]
    None = 0,
    /// The flash controller reported an error.
    Flash = 1,
    /// A record read back differently.
    NotProgrammed = 2,
    /// A sector was not blank after its erase.
    NotErased = 3,
    /// No writable sector is left.
    Full = 4,
}

impl ParamError {
    const ALL: [Self; 5] = [
        Self::None,
        Self::Flash,
        Self::NotProgrammed,
        Self::NotErased,
        Self::Full,
    ];

    /// Decodes a number from the wire (docs/tuning.md). The numbers never change.
    pub fn from_code(code: u8) -> Option<Self> {
        Self::ALL.into_iter().find(|error| *error as u8 == code)
    }
}

/// State of the store. Counters run since boot unless the name says otherwise.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct ParamStatus {
    /// Increases with every change of the other fields.
    pub revision: u32,
    /// The `TuningStatus::revision` to which `unsaved` and `state` refer. A later change is not saved.
    pub seen: u32,
    /// Records saved and read back.
    pub save_ok: u32,
    /// Attempts that failed, including erases.
    pub save_failed: u32,
    /// Erases attempted.
    pub erases: u32,
    /// Rotations to another sector since the store was new.
    pub generation: u32,
    /// Time in µs to read the store at boot.
    pub boot_us: u32,
    /// Longest time in µs that the chip stood still for an erase after boot.
    pub longest_stall_us: u32,
    /// Groups loaded at boot, one bit for each index in `tuning::PARAMETERS`.
    pub loaded: u32,
    /// Groups whose record has a later version or values that are not allowed, one bit each. Their defaults are in
    /// use. The record stays until the group is changed or set to its defaults, and that is saved. A bit set here
    /// blocks arming.
    pub refused: u32,
    /// Groups whose values are not in flash yet, one bit each.
    pub unsaved: u32,
    /// Slots of the active sector that were neither blank nor held a record at boot.
    pub damaged: u16,
    /// Records of groups that this firmware does not have, or of another make of joint motor. They are kept but not
    /// used.
    pub foreign: u16,
    /// Number of records that fit before the next rotation.
    pub free_slots: u16,
    /// Activity of the store.
    pub state: ParamState,
    /// Why the last failed attempt failed.
    pub last_error: ParamError,
    /// Sectors found ruined at boot by something other than a power cut. Settings saved there are lost, and older
    /// values or defaults are in use.
    pub lost_sectors: u8,
    /// Sectors found at boot with something other than settings, such as parts of an earlier firmware. They are
    /// erased when needed.
    pub strange_sectors: u8,
}

/// The flash operation that the parameter task requests. The control tick grants it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum FlashRequest {
    /// Nothing.
    #[default]
    None = 0,
    /// Program some words, each taking 16 µs and at most 100 µs.
    Program = 1,
    /// Erase a sector, for which the chip stands still for 0.25 to 0.5 s.
    Erase = 2,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_documented_codes_are_decoded() {
        let states: Vec<_> = (0..=u8::MAX).filter_map(ParamState::from_code).collect();
        assert_eq!(states, ParamState::ALL);
        let errors: Vec<_> = (0..=u8::MAX).filter_map(ParamError::from_code).collect();
        assert_eq!(errors, ParamError::ALL);
        assert_eq!(ParamState::from_code(5), Some(ParamState::BackingOff));
        assert_eq!(ParamError::from_code(4), Some(ParamError::Full));
    }
}
