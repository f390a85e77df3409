//! Writes the result of a calibration as one self-contained HTML page.

mod accel;
mod mag;

pub use accel::accel_report;
pub use mag::mag_report;
