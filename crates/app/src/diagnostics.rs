//! The state of the whole robot in one place, for debugger, log and recordings.

mod change_notice;
mod snapshot;
mod strangers;
mod tick_stats;

pub use change_notice::ChangeNotice;
pub use snapshot::DiagnosticsSnapshot;
pub use strangers::{BusStrangers, Strangers};
pub use tick_stats::TickStats;
