//! Makes the checks of a first board in their order. Each one says what to connect, what to type, what must be seen and
//! what to note. docs/first-board.md has the same list for reading.
//!
//! Nothing here moves a motor. Where one has to move, the check says how to do it with bring-up.

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
