//! The checks for whoever first has a board, in their order: what to connect, what to type, what must be seen, what to
//! note. docs/first-board.md is the same list for reading.
//!
//! Nothing here moves a motor: where one has to, the user is told how to do it with bring-up.

mod checks;
mod measured;
mod report;
mod walk;

pub use checks::{CHECKS, Check, Method};
pub use measured::{Measured, Verdict};
pub use report::{Entry, Outcome, Report, ReportError};
pub use walk::{Dialogue, WalkError, WalkOptions, walk};

#[cfg(test)]
mod tests;
