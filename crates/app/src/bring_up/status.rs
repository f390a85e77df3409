//! State of bring-up, for diagnostics.

/// Step of bring-up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum BringUpStep {
    /// Bring-up is off.
    #[default]
    Off = 0,
    /// Arming is blocked. The joints are turned by hand, and the log shows their angles.
    ReadOnly = 1,
    /// When armed, motors are enabled without torque.
    ZeroTorque = 2,
    /// When armed, one motor gives a little torque while the dead-man stick is held.
    OneMotor = 3,
}

/// State of the selected motor.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum TrialState {
    /// Bring-up is not in its third step.
    #[default]
    Idle = 0,
    /// The dead-man stick must be released first.
    ReleaseFirst = 1,
    /// The motor waits for the dead-man stick.
    Ready = 2,
    /// The motor has torque.
    Active = 3,
    /// Released because it turned too fast.
    TooFast = 4,
    /// Released because the torque lasted too long.
    TooLong = 5,
    /// Released because it does not report.
    Silent = 6,
}

/// State of bring-up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(C)]
pub struct BringUpStatus {
    /// Present step.
    pub step: BringUpStep,
    /// Selected motor, 0 to 5. It matters only in the third step.
    pub motor: u8,
    /// State of the selected motor.
    pub trial: TrialState,
    /// The radio selects step and motor; otherwise the tuning channel does.
    pub by_radio: bool,
}
