//! The PC's end of the robot's tuning channel (docs/tuning.md).

mod apply;
mod bank_report;
mod boot_findings;
mod bring_up;
mod client;
mod live;
mod recording_report;
mod request;
mod saving;
mod store_report;
mod wheel_geometry;

#[cfg(test)]
pub(crate) mod testing;
#[cfg(test)]
mod tests;

pub use apply::{Applied, ApplyError, apply};
pub use bank_report::BankReport;
pub use boot_findings::BootFindings;
pub use bring_up::{BringUpStep, Joint, Motor, Trial};
pub use client::{Timeouts, TuningClient, TuningError};
pub use live::{LiveQuestion, LiveReading, live_page};
pub use recording_report::RecordingReport;
pub use saving::{SaveError, SaveTimeouts, wait_until_saved};
pub use store_report::StoreReport;
pub use wheel_geometry::{GeometryError, WheelGeometry};
