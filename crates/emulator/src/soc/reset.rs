//! Why the chip starts again.

/// Sets the flag of the same name in RCC_CSR (RM0090 7.3.21).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ResetCause {
    /// The supply came up.
    PowerOn,
    /// SYSRESETREQ.
    Software,
    /// The independent watchdog ran out.
    IndependentWatchdog,
}
