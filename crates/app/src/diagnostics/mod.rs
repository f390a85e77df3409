//! The state of the whole robot in one place, for debugger, log and recordings.

mod snapshot;
mod tick_stats;

pub use snapshot::DiagnosticsSnapshot;
pub use tick_stats::TickStats;
