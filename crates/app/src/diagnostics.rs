//! The diagnostics stage: the state of the whole robot in one place, for debugger, log and recordings.

mod change_throttle;
mod snapshot;
mod telemetry;
mod tick_stats;
mod unknown_frames;

pub use change_throttle::ChangeThrottle;
pub use snapshot::DiagnosticsSnapshot;
pub use telemetry::{TELEMETRY_PERIOD_TICKS, Telemetry};
pub use tick_stats::TickStats;
pub use unknown_frames::{BusUnknownFrames, UnknownFrames};
