//! Bring-up for diagnostics.

/// How far bring-up has been taken.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum BringUpStep {
    #[default]
    Off = 0,
    /// Arming is blocked; turn the joints by hand and watch the log.
    ReadOnly = 1,
    /// Once armed, motors are enabled and told to give nothing.
    ZeroTorque = 2,
    /// Once armed, one motor gives a little torque while the dead-man stick is held.
    OneMotor = 3,
}

/// What the motor on trial does, and why it gives nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum TrialState {
    /// Not the third step.
    #[default]
    Idle = 0,
    /// The dead-man stick must be let go first.
    ReleaseFirst = 1,
    /// Waits for the dead-man stick.
    Ready = 2,
    Active = 3,
    /// Let go: it turned too fast.
    TooFast = 4,
    /// Let go: it pushed for too long.
    TooLong = 5,
    /// Let go: it does not report.
    Silent = 6,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(C)]
pub struct BringUpStatus {
    pub step: BringUpStep,
    /// Chosen motor, 0 to 5; counts in the third step only.
    pub motor: u8,
    pub trial: TrialState,
    /// The radio picks step and motor; otherwise the tuning channel.
    pub by_radio: bool,
}
