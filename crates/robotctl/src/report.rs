//! What a calibration found, as one self-contained HTML page.

mod accel;
mod chart;
mod mag;
mod page;

pub use accel::accel_report;
pub use mag::mag_report;

#[derive(Debug, thiserror::Error)]
#[error("cannot draw a plot: {0}")]
pub struct ReportError(String);

impl ReportError {
    fn new(error: impl std::fmt::Display) -> Self {
        Self(error.to_string())
    }
}
