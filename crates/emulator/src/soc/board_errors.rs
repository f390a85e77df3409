//! Settings and accesses that fail silently on silicon. Each entry names the error and its consequence.

use crate::time::Ps;

/// A wrong setting or access.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BoardError {
    /// Time of the first report.
    pub at: Ps,
    /// Number of reports.
    pub count: u64,
    /// The error and its consequence.
    pub message: String,
}

/// Distinct messages by severity, in the order in which they were first reported.
#[derive(Debug, Default)]
pub struct BoardErrors {
    failing: Vec<BoardError>,
    suspicious: Vec<BoardError>,
}

impl BoardErrors {
    /// Reports an error that fails on silicon.
    pub fn report(&mut self, at: Ps, message: impl Into<String>) {
        note(&mut self.failing, at, message.into());
    }

    /// Reports a setting or access that is only suspicious.
    pub fn suspect(&mut self, at: Ps, message: impl Into<String>) {
        note(&mut self.suspicious, at, message.into());
    }

    /// Errors that fail on silicon, and so fail the run.
    pub fn list(&self) -> &[BoardError] {
        &self.failing
    }

    /// Settings and accesses that work on some specimens only, or with less accuracy.
    pub fn suspicions(&self) -> &[BoardError] {
        &self.suspicious
    }
}

fn note(list: &mut Vec<BoardError>, at: Ps, message: String) {
    match list.iter_mut().find(|e| e.message == message) {
        Some(e) => e.count += 1,
        None => list.push(BoardError {
            at,
            count: 1,
            message,
        }),
    }
}
