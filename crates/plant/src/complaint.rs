//! Complaints of a device or chip that was used outside of its maker's limits.

/// Consequence of the misuse on a real board.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// It fails on all or on some specimens: the access is ignored, lost, garbled or undefined, or a limit is exceeded
    /// that no known board exceeds with success.
    Fails,
    /// The datasheet does not promise it, or others advise against it, but boards that do it are known to run, or it costs
    /// accuracy only.
    Suspicious,
}

/// One misuse of a device.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Complaint {
    /// Consequence of the misuse.
    pub severity: Severity,
    /// The device, what was done, and the limit.
    pub text: String,
}

impl Complaint {
    /// A misuse that fails on a real board.
    pub fn fails(text: impl Into<String>) -> Self {
        Self {
            severity: Severity::Fails,
            text: text.into(),
        }
    }

    /// A misuse that may work on a real board.
    pub fn suspicious(text: impl Into<String>) -> Self {
        Self {
            severity: Severity::Suspicious,
            text: text.into(),
        }
    }
}
