//! Why the chip starts again.

/// Sets the flag of the same name in RCC_CSR (RM0090 7.3.21).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ResetCause {
    PowerOn,
    /// SYSRESETREQ.
    Software,
    IndependentWatchdog,
}
