//! What the parameter store says about itself, and what it asks the control tick for.

/// What the store is about.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum ParamState {
    /// Flash holds what is in use.
    #[default]
    Saved = 0,
    /// Something changed; it is saved once nothing has changed for 500 ms.
    Settling = 1,
    /// Armed, or motors may still turn: flash is left alone.
    WaitingForRest = 2,
    Saving = 3,
    /// A sector is being erased: the chip stands still.
    Erasing = 4,
    /// The last attempt failed; the next one comes after 1, 10, 60 or 300 s.
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

    /// The numbers are on the wire (docs/tuning.md) and never change.
    pub fn from_code(code: u8) -> Option<Self> {
        Self::ALL.into_iter().find(|state| *state as u8 == code)
    }
}

/// Why an attempt failed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum ParamError {
    /// None has.
    #[default]
    None = 0,
    /// The flash controller reported an error.
    Flash = 1,
    /// A record read back differently.
    NotProgrammed = 2,
    /// A sector was not blank after its erase.
    NotErased = 3,
    /// No sector left that can be written.
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

    /// The numbers are on the wire (docs/tuning.md) and never change.
    pub fn from_code(code: u8) -> Option<Self> {
        Self::ALL.into_iter().find(|error| *error as u8 == code)
    }
}

/// Counters since boot unless the name says otherwise.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct ParamStatus {
    /// Grows with every change of the other fields.
    pub revision: u32,
    /// The `TuningStatus::revision` that `unsaved` and `state` know of: a younger change is not saved.
    pub seen: u32,
    /// Records saved and read back.
    pub save_ok: u32,
    /// Attempts that failed, erases among them.
    pub save_failed: u32,
    pub erases: u32,
    /// Times a sector became the active one, since the store was new.
    pub generation: u32,
    /// Reading the store at boot.
    pub boot_us: u32,
    /// The longest time the chip stood still for an erase after boot.
    pub longest_stall_us: u32,
    /// Found at boot; bits are positions in `tuning::PARAMETERS`.
    pub loaded: u32,
    /// Found, but of a later version or with values that are not allowed: the defaults are in use, and the record stays
    /// until someone changes the group or gives it its defaults, and that is saved. A bit set here blocks arming.
    pub refused: u32,
    /// Groups whose values are not in flash yet.
    pub unsaved: u32,
    /// Places in the active sector that hold neither a record nor nothing, as found at boot.
    pub damaged: u16,
    /// Records of groups this firmware does not have, or of another make of joint motor: kept but not used.
    pub foreign: u16,
    /// Records that fit before the next sector is begun.
    pub free_slots: u16,
    pub state: ParamState,
    pub last_error: ParamError,
    /// Sectors found ruined at boot by something else than a power cut: settings saved there are gone, and older values
    /// or defaults are in use.
    pub lost_sectors: u8,
    /// Sectors found at boot to hold something else than settings, such as parts of a firmware flashed before this one.
    /// They are erased when their turn comes.
    pub strange_sectors: u8,
}

/// What the parameter task wants to do to flash; the control tick says when it may.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum FlashRequest {
    #[default]
    None = 0,
    /// Words of 16 µs each, up to 100 µs.
    Program = 1,
    /// Everything on the chip waits for 0.25 to 0.5 s.
    Erase = 2,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_those_of_the_wire_and_no_others() {
        let states: Vec<_> = (0..=u8::MAX).filter_map(ParamState::from_code).collect();
        assert_eq!(states, ParamState::ALL);
        let errors: Vec<_> = (0..=u8::MAX).filter_map(ParamError::from_code).collect();
        assert_eq!(errors, ParamError::ALL);
        assert_eq!(ParamState::from_code(5), Some(ParamState::BackingOff));
        assert_eq!(ParamError::from_code(4), Some(ParamError::Full));
    }
}
