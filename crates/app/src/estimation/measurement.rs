//! The scalar measurement that the sensors' parts of the estimator hand to its Kalman filters.

/// One measurement of one error state.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Measurement {
    /// The measured value less the predicted one, in the unit of the state.
    pub innovation: f32,
    /// Variance of the measurement noise (R), in the square of that unit.
    pub variance: f32,
}
