//! How accurately the attitude is known.

/// Variances of the attitude error, rad².
#[derive(Clone, Copy, Debug)]
pub(super) struct AttitudeVariance {
    /// The larger of the variances about the two level axes.
    pub tilt: f32,
    /// Variance about the vertical.
    pub heading: f32,
}
