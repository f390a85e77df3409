//! Recorded motion through the firmware's estimator.
