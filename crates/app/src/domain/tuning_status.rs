//! State of the tuning channel, for diagnostics.

/// Counters since boot.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct TuningStatus {
    /// Requests executed, including reads.
    pub accepted: u32,
    /// Requests refused.
    pub refused: u32,
    /// Requests neither executed nor answered: a second one in the same slot on the same bus.
    pub dropped: u32,
    /// Increases whenever a setting or `restored` changes.
    pub revision: u32,
    /// Groups that were set to their defaults, one bit for each index in `PARAMETERS`.
    pub restored: u32,
    /// Numbers of the events of the black box that were released last, 0 = none. Index = bank.
    pub black_box_released: [u16; 2],
    /// Code of the last refusal: see `Refusal`; 0 = none yet.
    pub last_refusal: u8,
}
