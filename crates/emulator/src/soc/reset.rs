//! Causes of a reset.

/// Cause of a reset, with a flag in RCC_CSR (RM0090 7.3.21).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ResetCause {
    /// The supply came up.
    PowerOn,
    /// Software set SYSRESETREQ.
    Software,
    /// The independent watchdog ran out.
    IndependentWatchdog,
}
