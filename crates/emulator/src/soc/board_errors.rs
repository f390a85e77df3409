//! What real silicon would punish silently, said aloud: each entry names the wrong setting and what it breaks.

use crate::time::Ps;

/// One wrong setting or access.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BoardError {
    /// When it was first seen.
    pub at: Ps,
    /// How often it was seen.
    pub count: u64,
    /// What is wrong, and what it breaks.
    pub message: String,
}

/// Distinct messages in the order they were first seen, by severity.
#[derive(Debug, Default)]
pub struct BoardErrors {
    failing: Vec<BoardError>,
    suspicious: Vec<BoardError>,
}

impl BoardErrors {
    /// Fails on silicon.
    pub fn report(&mut self, at: Ps, message: impl Into<String>) {
        note(&mut self.failing, at, message.into());
    }

    /// Suspicious only.
    pub fn suspect(&mut self, at: Ps, message: impl Into<String>) {
        note(&mut self.suspicious, at, message.into());
    }

    /// What fails on silicon, and so fails the run.
    pub fn list(&self) -> &[BoardError] {
        &self.failing
    }

    /// What works on some specimens only, or with less accuracy.
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
