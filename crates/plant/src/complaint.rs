//! What a device or chip was asked to do beyond what its makers promise.

/// What such a demand comes to on a real board.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// It does not work, or works on some specimens only: ignored, lost, garbled, undefined, or beyond a limit that
    /// nobody is known to exceed with success.
    Fails,
    /// Outside what the datasheet promises or others recommend, but boards that do it are known to run, or only
    /// accuracy suffers.
    Suspicious,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Complaint {
    pub severity: Severity,
    pub text: String,
}

impl Complaint {
    pub fn fails(text: impl Into<String>) -> Self {
        Self {
            severity: Severity::Fails,
            text: text.into(),
        }
    }

    pub fn suspicious(text: impl Into<String>) -> Self {
        Self {
            severity: Severity::Suspicious,
            text: text.into(),
        }
    }
}
