//! The tuning channel for diagnostics.

/// Counters since boot.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct TuningStatus {
    /// Requests that were done, reads included.
    pub accepted: u32,
    pub refused: u32,
    /// Requests left undone and unanswered: a second one in the same slot on the same bus.
    pub dropped: u32,
    /// Grows whenever a setting or `restored` changes.
    pub revision: u32,
    /// Groups that were given their defaults; bits are positions in `PARAMETERS`.
    pub restored: u32,
    /// Of the last refusal: see `Refusal`; 0 = none yet.
    pub last_refusal: u8,
}
